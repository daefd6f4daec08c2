#include "common/hand/probe_picture.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <utility>

#include "common/base/index.h"
#include "common/hand/drawn/followed_curve.h"
#include "common/hand/fixture_view.h"
#include "common/hand/touch_options.h"
#include "common/servo/hand_step.h"

namespace palpate {

double ball_interval(const VectorField& field, const Workspace& workspace) noexcept {
  constexpr double kTicks = 4.0;
  return kTicks * default_tick_interval(field, workspace);
}

std::optional<ValueRange> tension_range(const ChainSettings& settings, double force_cap) {
  const double most = std::min(force_cap, settings.stiffness * settings.anisotropy.tau.highest());
  return most > 0.0 ? std::optional(ValueRange{0.0, most}) : std::nullopt;
}

std::vector<Vec3> link_proxies(const ChainStep& step, const Workspace& workspace) {
  std::vector<Vec3> places;
  for (int i = 0; i < step.links; ++i)
    places.push_back(workspace.data_from_workspace(step.proxies[as_size(i)]));
  return places;
}

std::vector<std::string> take_fixtures(const TouchOptions& options, const Box& bounds, HapticScene& scene,
                                       SceneView& view, Progress* progress) {
  FixtureStore store;
  scene.fixtures = store.list(options.fixtures.list, progress);
  for (SurfaceView& surface : show_fixtures(scene.fixtures, scene.workspace, bounds))
    view.surfaces.push_back(std::move(surface));
  std::vector<std::string> notes;
  for (const auto& fixture : scene.fixtures)
    notes.insert(notes.end(), fixture->notes.begin(), fixture->notes.end());
  return notes;
}

struct PathHand::State {
  std::vector<PathRow> path;
  HapticScene scene;
  TouchOptions options;
  LineStyle style;
  HandStepper stepper;
  std::optional<FollowedCurve> followed;
  std::size_t next = 0;  ///< row
  HandStep step;
  ProbeView view;
  std::shared_ptr<ProbePath> taken = std::make_shared<ProbePath>();

  void go_on() {
    constexpr double kNotThere = std::numeric_limits<double>::quiet_NaN();
    const Workspace& workspace = scene.workspace;
    const PathRow& row = path[next++];
    HandInput hand{.time = row.time, .present = true};
    hand.sample = {row.time, workspace.workspace_from_data(row.position), row.buttons};
    step = stepper.step(hand);
    if (step.chain.jumped || step.state == HoldState::kFault) taken->append(Vec3{kNotThere}, 0.0);
    if (step.chain.links == 0) return;
    view.probe = workspace.data_from_workspace(step.probe);
    view.proxy = workspace.data_from_workspace(step.chain.proxies[0]);
    view.force = glm::length(step.force);
    taken->append(view.proxy, view.force);
  }
};

PathHand::PathHand(std::vector<PathRow> path, HapticChain made, const HapticScene& scene,
                   const TouchOptions& options, const LineStyle& style)
    : state_(new State{.path = std::move(path),
                       .scene = scene,
                       .options = options,
                       .style = style,
                       .stepper = HandStepper(std::move(made.chain), touch_limits(options)),
                       .followed = {},
                       .step = {},
                       .view = {}}) {
  if (made.followed) state_->followed.emplace(made.followed);
  state_->view.force_cap = touch_limits(options).force_cap;
}

PathHand::~PathHand() = default;

ProbeView PathHand::at(double part) {
  State& s = *state_;
  if (!s.path.empty()) {
    const double until = std::lerp(s.path.front().time, s.path.back().time, part);
    while (s.next < s.path.size() && (part >= 1.0 || s.next == 0 || s.path[s.next].time <= until)) s.go_on();
  }
  const Workspace& workspace = s.scene.workspace;
  ProbeView view = s.view;
  view.links = link_proxies(s.step.chain, workspace);
  if (s.options.show_path) view.path = PathView{s.taken, s.taken->size(), std::nullopt};
  if (s.scene.field) {
    CellHint hint;
    const VectorSample sample = s.scene.field->sample(view.proxy, hint);
    if (sample.status == SampleStatus::kOk) view.velocity = sample.value;
  }
  // Of a heart the tensors are its fibres, which have no glyph.
  if (s.scene.tensor && !s.scene.scalar) {
    CellHint hint;
    const TensorSample sample = s.scene.tensor->sample(view.proxy, hint);
    if (sample.status == SampleStatus::kOk) view.tensor = sample.value;
    view.path.range = tension_range(s.scene.settings, view.force_cap);
  }
  if (s.followed) {
    s.followed->update(s.options.stream_balls ? ball_interval(*s.scene.field, workspace) : 0.0, s.style);
    view.followed = s.followed->drawn();
  }
  return view;
}

double reference_speed(const SceneView& view) {
  return view.lines ? value_range(*view.lines, LineStyle{.color_by = ColorBy::kSpeed}).upper : 0.0;
}

void fade_lines(SceneView& view) {
  // Thin opaque lines, not transparent ones: these would have to be drawn again with every move of the hand.
  constexpr double kDimmed = 0.55, kThinned = 0.5;
  view.style.dimming = kDimmed;
  view.style.width *= kThinned;
  view.style.halo = false;
}

}  // namespace palpate
