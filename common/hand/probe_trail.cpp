#include "common/hand/probe_trail.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "common/base/index.h"
#include "common/hand/probe_picture.h"

namespace palpate {
namespace {

constexpr double kNotThere = std::numeric_limits<double>::quiet_NaN();
constexpr double kPathSpacing = 2e-4;  // diagonals
constexpr std::size_t kMostHaptic = 1U << 20U;

bool is_on_line(const HandStep& step) {
  return step.state == HoldState::kHeld || step.state == HoldState::kFellBack;
}

}  // namespace

void ProbeTrail::open_data() {
  hints_ = {};
  readout_ = {};
  if (drawing_) drawing_->let_go();
  const HandMade before = made();
  drawing_.reset();
  if (data_.has_tensors()) drawing_.emplace(data_.field().tensor);
  clear_path();
  put(before);
  if (curve_) curve_->forget();
}

void ProbeTrail::follow(const HapticChain& made) {
  if (made.followed) {
    // Not in the place of the one before, whose shape it goes on with.
    FollowedCurve next(made.followed, curve_ ? &*curve_ : nullptr);
    curve_ = std::move(next);
  } else {
    curve_.reset();
  }
  follows_surface_ = made.surfaces_of != nullptr;
  haptic_forces_.clear();
}

void ProbeTrail::clear_path() {
  if (drawing_) {
    drawing_->clear();
    path_ = drawing_->path();
    return;
  }
  path_ = std::make_shared<ProbePath>(data_.empty() ? 0.0 : kPathSpacing * data_.field().diagonal());
}

void ProbeTrail::take(const HandStep& step, bool on_dial, StrokeUse stroke) {
  if (step.present) read_step(step);
  if (!step.present || on_dial) {
    path_->append(Vec3{kNotThere}, 0.0);
    if (drawing_) drawing_->let_go();
    held_before_ = false;
    if (!step.present) readout_.held = readout_.acts = false;
    return;
  }
  const bool on_line = is_on_line(step);
  if (step.chain.jumped) {
    path_->append(Vec3{kNotThere}, 0.0);
    other_line_ = true;
  }
  if (on_line && other_line_) {
    haptic_forces_.clear();
    other_line_ = false;
    // A line is popped over to when the next one holds; a surface is behind when it lets go.
    if (held_before_ && data_.has_flow() && !follows_surface_) ++readout_.popped;
  }
  if (follows_surface_ && step.state == HoldState::kReleased) ++readout_.popped;
  held_before_ = held_before_ || on_line;
  draw_path(step, on_line, stroke);
}

void ProbeTrail::read_step(const HandStep& step) {
  const Workspace workspace = data_.workspace();
  // What the hand is pulled by is the last proxy; those before it lie on the way. A flow's line is followed
  // by the first one, which a drag leaves behind; on a heart's layer the groove is what is followed.
  const auto last = as_size(std::max(step.chain.links, 1)) - 1;
  const std::size_t shown = data_.has_wall() ? last : 0;
  readout_.held = true;
  readout_.acts = (step.buttons & 1U) != 0;
  readout_.state = step.state;
  readout_.cut = step.cut;
  readout_.probe = workspace.data_from_workspace(step.probe);
  readout_.proxy =
      workspace.data_from_workspace(step.chain.links > 0 ? step.chain.proxies[shown] : step.probe);
  readout_.links = link_proxies(step.chain, workspace);
  readout_.residual = step.chain.residual / workspace.scale();
  readout_.force = glm::length(step.force);
  readout_.perceived_stiffness = step.chain.perceived_stiffness;
  constexpr double kMillimetres = 1e3;
  readout_.stretch =
      step.chain.links > 0 ? kMillimetres * glm::distance(step.chain.proxies[last], step.probe) : 0.0;
}

/// The path, a tract or the forces along the line go on to the proxy.
void ProbeTrail::draw_path(const HandStep& step, bool on_line, StrokeUse stroke) {
  const Vec3& proxy = readout_.proxy;
  const double force = readout_.force;
  if (drawing_) drawing_->draw(step, proxy, force, stroke);
  if (drawing_ && drawing_->redrawn()) path_ = drawing_->path();
  if (!drawing_ || !drawing_->joining()) path_->append(on_line ? proxy : Vec3{kNotThere}, force);
  if (!on_line) return;
  const double spacing = kPathSpacing * data_.field().diagonal();
  if (haptic_forces_.empty() || glm::distance(haptic_forces_.back().position, proxy) > spacing) {
    if (haptic_forces_.size() < kMostHaptic) haptic_forces_.push_back({proxy, force});
  } else {
    haptic_forces_.back().force = force;
  }
}

void ProbeTrail::update(bool show_balls, const LineStyle& style) {
  if (curve_) {
    const std::shared_ptr<const FollowedLine> before = curve_->drawn();
    curve_->update(show_balls ? ball_interval(*data_.field().field, data_.workspace()) : 0.0, style);
    growing_ = curve_->drawn() != before;
  }
  if (readout_.held) read_data(data_.field(), data_.noise().get(), hints_, readout_);
}

void ProbeTrail::describe(const TouchChoice& choice, double force_cap, bool on_dial, ProbeView& view) const {
  view.probe = readout_.held ? readout_.probe : Vec3{kNotThere};
  view.proxy = readout_.held ? readout_.proxy : Vec3{kNotThere};
  view.links.clear();
  if (readout_.held && !on_dial) view.links = readout_.links;
  view.force = readout_.force;
  view.force_cap = force_cap;
  view.velocity = readout_.held && readout_.sampled ? readout_.velocity : Vec3{0.0};
  view.tensor = readout_.held ? readout_.tensor : std::nullopt;
  // A hand outside the data follows nothing.
  const bool outside = readout_.held && readout_.state == HoldState::kOutside;
  // What is let go stays in the picture until the next line is caught.
  view.followed = curve_ && !outside ? curve_->last() : nullptr;
  const std::optional<ValueRange> tension =
      data_.has_tensors() ? tension_range(choice.settings, force_cap) : std::nullopt;
  view.path = choice.show_path ? PathView{path_, path_->size(), tension} : PathView{};
  view.seeds = data_.lines();
  view.drawn_lines = drawn_lines_.drawn();
}

void ProbeTrail::note_line() {
  noted_.reset();
  if (drawing_ && readout_.held) drawing_->note();
  if (!readout_.held || (curve_ && curve_->number() == 0)) return;
  noted_ = followed();
}

std::optional<ProbeTrail::NotedLine> ProbeTrail::followed() const {
  if (curve_) {
    if (curve_->line().points.size() < 2) return std::nullopt;
    return NotedLine{curve_->line(), forces_along(curve_->line(), haptic_forces_)};
  }
  if (!data_.has_wall() || path_->pieces().empty()) return std::nullopt;
  const std::size_t first = path_->pieces().back();
  NotedLine way;
  way.line.end = End::kStoppedByRule;
  double arc = 0.0;
  for (std::size_t i = first; i < path_->size(); ++i) {
    if (i > first) arc += glm::distance(path_->positions()[i - 1], path_->positions()[i]);
    way.line.points.push_back({.position = path_->positions()[i], .arc = arc});
    way.forces.push_back(path_->forces()[i]);
  }
  if (way.line.points.size() < 2) return std::nullopt;
  return way;
}

void ProbeTrail::forget_note() {
  noted_.reset();
  if (drawing_) drawing_->forget_note();
}

ProbeTrail::Keeping ProbeTrail::keep_line() {
  if (drawing_) {
    if (!drawing_->keep(drawn_lines_)) return Keeping::kNothing;
    path_ = drawing_->path();
    return Keeping::kKept;
  }
  auto line = followed();
  return line ? keep(line->line, std::move(line->forces)) : Keeping::kNothing;
}

ProbeTrail::Keeping ProbeTrail::keep_noted_line() {
  if (drawing_ && readout_.held) drawing_->cut_to_note();
  return noted_ && readout_.held ? keep(noted_->line, noted_->forces) : keep_line();
}

ProbeTrail::Keeping ProbeTrail::keep(const Line& line, std::vector<double> forces) {
  if (drawn_lines_.ends_with(line, forces)) return Keeping::kAlready;
  drawn_lines_.keep(line, std::move(forces));
  return Keeping::kKept;
}

HandMade ProbeTrail::made() const {
  return {.kept = drawn_lines_.all(), .drawn = drawing_ ? drawing_->drawn() : nullptr};
}

void ProbeTrail::put(const HandMade& made) {
  if (drawn_lines_.all() != made.kept) drawn_lines_.put(made.kept);
  if (!drawing_ || made.drawn == nullptr || drawing_->drawn() == made.drawn) return;
  drawing_->put(made.drawn);
  path_ = drawing_->path();
}

void ProbeTrail::forget() {
  drawn_lines_.clear();
  if (!drawing_) return;
  drawing_->put(std::make_shared<const std::vector<DrawnTract>>());
  path_ = drawing_->path();
}

}  // namespace palpate
