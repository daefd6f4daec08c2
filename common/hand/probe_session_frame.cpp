// What a ProbeSession does once a frame: it takes the steps that the servo has done, and says what is drawn
// and read out of them.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <variant>
#include <vector>

#include "common/hand/mode/chain_description.h"
#include "common/hand/probe_picture.h"
#include "common/hand/probe_session.h"

namespace palpate {
namespace {

constexpr double kNotThere = std::numeric_limits<double>::quiet_NaN();
constexpr double kPathSpacing = 2e-4;  // diagonals
constexpr double kLocalReach = 0.06;   // diagonals: half the length of a rake
constexpr double kLocalLength = 0.25;  // diagonals: of its lines, either way
constexpr int kRakeSeeds = 11, kPlaneSeeds = 6;
constexpr std::size_t kMostFelt = 1U << 20U;

}  // namespace

void ProbeSession::clear_path() {
  if (drawing_) {
    drawing_->clear();
    path_ = drawing_->path();
    return;
  }
  path_ = std::make_shared<ProbePath>(open_.empty() ? 0.0 : kPathSpacing * open_.diagonal());
}

void ProbeSession::update(double time, const Camera& camera, ColorBy color_by, ProbeView& view) {
  if (!servo_) return;
  if (measures_noise()) noises_->request(open_.scalar);
  if (!replay_ && !textured_ && chain_settings().texture.by_noise) restart_chain();
  // Before planes are carried on: of that edit nothing can have been told yet.
  planes_.read(choice_.settings.plane_widget.edit);
  if (hands_ && !replay_) follow_hands(time);
  seen_ = camera;
  if (mouse_->grabbed()) mouse_->move(time, workspace().workspace_from_data(intent().probe), buttons());
  if (placed_) placed_->place(placement(camera));
  if (const LinkedDevice* const real = linked_ ? linked_.get() : options_.tracker.get())
    readout_.device = real->advice();
  servo_->collect_retired();
  servo_->read(readout_.servo);
  if (faults_) readout_.fault = faults_->news().value_or(readout_.fault);
  HandStep step;
  while (servo_->pop_step(step)) take(step);
  if (curve_) {
    const std::shared_ptr<const FollowedLine> before = curve_->drawn();
    curve_->update(choice_.show_balls ? ball_interval(*open_.field, workspace()) : 0.0, color_by);
    growing_ = curve_->drawn() != before;
    // What is let go stays in the picture until the next line is caught.
    if (curve_->drawn()) last_drawn_ = curve_->drawn();
  }
  if (readout_.held) read_data(open_, noise_.get(), hints_, readout_);
  ask_local(camera);
  surfaces_->request(choice_.show_surface ? felt_levels() : FeltLevels{});
  describe(view);
}

void ProbeSession::take(const HandStep& step) {
  const Vec3 gap{kNotThere};
  if (replay_) follow_replayed_chain(step.number);
  if (!step.present) {
    path_->append(gap, 0.0);
    if (drawing_) drawing_->let_go();
    readout_.held = readout_.acts = false;
    held_before_ = false;
    return;
  }
  const Workspace workspace = this->workspace();
  // What the hand is pulled by is the last proxy; those before it lie on the way. A flow's line is followed
  // by the first one, which a drag leaves behind; on a heart's layer the groove is what is followed.
  const bool heart = open_.tensor && open_.scalar && !open_.field;
  const auto last = static_cast<std::size_t>(std::max(step.chain.links, 1)) - 1;
  const std::size_t shown = heart ? last : 0;
  const Vec3 proxy =
      workspace.data_from_workspace(step.chain.links > 0 ? step.chain.proxies[shown] : step.probe);
  const double force = glm::length(step.force);
  const bool on_line = step.state == HoldState::kHeld || step.state == HoldState::kFellBack;
  readout_.held = true;
  readout_.acts = (step.buttons & 1U) != 0;
  readout_.state = step.state;
  readout_.cut = step.cut;
  readout_.probe = workspace.data_from_workspace(step.probe);
  readout_.proxy = proxy;
  readout_.links = link_proxies(step.chain, workspace);
  readout_.residual = step.chain.residual / workspace.scale();
  readout_.force = force;
  constexpr double kMillimetres = 1e3;
  readout_.stretch =
      step.chain.links > 0 ? kMillimetres * glm::distance(step.chain.proxies[last], step.probe) : 0.0;
  if (dial_) {
    path_->append(gap, 0.0);
    if (drawing_) drawing_->let_go();
    held_before_ = false;
    return;
  }
  if (step.chain.jumped) {
    path_->append(gap, 0.0);
    other_line_ = true;
  }
  if (on_line && other_line_) {
    felt_.clear();
    other_line_ = false;
    // A line is popped over to when the next one holds; a surface is behind when it lets go.
    if (held_before_ && has_flow() && !surfaces_of_) ++readout_.popped;
  }
  if (surfaces_of_ && step.state == HoldState::kReleased) ++readout_.popped;
  held_before_ = held_before_ || on_line;
  if (drawing_) drawing_->draw(step, proxy, force, choice_.stroke);
  if (drawing_ && drawing_->redrawn()) path_ = drawing_->path();
  if (!drawing_ || !drawing_->joining()) path_->append(on_line ? proxy : gap, force);
  const double spacing = kPathSpacing * open_.diagonal();
  if (!on_line) {
    // Nothing is felt of a line.
  } else if (felt_.empty() || glm::distance(felt_.back().position, proxy) > spacing) {
    if (felt_.size() < kMostFelt) felt_.push_back({proxy, force});
  } else {
    felt_.back().force = force;
  }
}

/// In a replay the chains change by themselves: draws the line of the one that is in place.
void ProbeSession::follow_replayed_chain(std::uint64_t step) {
  const std::vector<RecordedChange>& changes = replay_->recording().changes;
  for (; next_change_ < changes.size() && changes[next_change_].step <= step; ++next_change_) {
    if (const auto* chain = std::get_if<ChainChange>(&changes[next_change_].change)) {
      follow_chain(replay_chains_[chain->chain]);
      const std::string& description = replay_->recording().chains[chain->chain];
      replayed_isovalues_ = parse_chain(description).settings.isosurface.isovalues;
    } else if (const auto* settings = std::get_if<ChainSettings>(&changes[next_change_].change)) {
      replayed_isovalues_ = settings->isosurface.isovalues;
    }
  }
}

void ProbeSession::ask_local(const Camera& camera) {
  LocalRequest request;
  if (choice_.local != SeedShape::kNone && readout_.held && has_flow()) {
    const double diagonal = open_.field->diagonal();
    request.field = open_.field;
    request.shape = choice_.local;
    request.center = readout_.probe;
    request.along = kLocalReach * diagonal * camera.axes[0];
    if (request.shape == SeedShape::kPlane) request.across = kLocalReach * diagonal * camera.axes[1];
    request.seeds = request.shape == SeedShape::kPlane ? kPlaneSeeds : kRakeSeeds;
    request.length = kLocalLength * diagonal;
  }
  local_->request(request);
}

void ProbeSession::describe(ProbeView& view) const {
  view.probe = readout_.held ? readout_.probe : Vec3{kNotThere};
  view.proxy = readout_.held ? readout_.proxy : Vec3{kNotThere};
  view.links.clear();
  if (readout_.held && !dial_) view.links = readout_.links;
  view.force = readout_.force;
  view.force_cap = options_.limits.force_cap;
  view.velocity = readout_.held && readout_.sampled ? readout_.velocity : Vec3{0.0};
  view.tensor = readout_.held ? readout_.tensor : std::nullopt;
  // A hand outside the data follows nothing.
  const bool outside = readout_.held && readout_.state == HoldState::kOutside;
  view.followed = curve_ && !outside ? last_drawn_ : nullptr;
  view.path = choice_.show_path ? PathView{path_, path_->size(), tension_range()} : PathView{};
  view.seeds = local_->drawn();
  view.kept = kept_.drawn();
}

/// Of the path through tensors: up to the most that their thresholds let the hand feel, which may be little
/// of what the device could show. None elsewhere.
std::optional<ValueRange> ProbeSession::tension_range() const {
  const ChainSettings& settings = choice_.settings;
  const double most =
      std::min(options_.limits.force_cap, settings.stiffness * settings.anisotropy.tau.highest());
  return has_tensors() && most > 0.0 ? std::optional(ValueRange{0.0, most}) : std::nullopt;
}

bool ProbeSession::lively() const noexcept {
  return mouse_->grabbed() || growing_ ||
         ((path_device_ || hands_ || simulated_ || linked_) && readout_.held) ||
         (replay_ && !readout_.servo.replay_done);
}

FeltLevels ProbeSession::felt_levels() const {
  if (!surfaces_of_) return {};
  const Isovalues& chosen = replay_ ? replayed_isovalues_ : choice_.settings.isosurface.isovalues;
  return {surfaces_of_, chosen.count > 0 ? chosen : chain_isovalues_};
}

FeltSurfaces::Made ProbeSession::surfaces() const {
  return surfaces_ ? surfaces_->made() : FeltSurfaces::Made{};
}

std::optional<double> ProbeSession::surfaces_fraction() const {
  return surfaces_ ? surfaces_->fraction() : std::nullopt;
}

}  // namespace palpate
