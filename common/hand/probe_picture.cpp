#include "common/hand/probe_picture.h"

#include <limits>
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

ProbeView probe_after(std::span<const PathRow> path, HapticChain made, const HapticScene& scene,
                      const TouchOptions& options, const LineStyle& style) {
  const DeviceLimits limits = touch_limits(options);
  const Workspace& workspace = scene.workspace;
  constexpr double kNotThere = std::numeric_limits<double>::quiet_NaN();
  ProbeView view;
  view.force_cap = limits.force_cap;
  const auto taken = std::make_shared<ProbePath>();
  HandStepper stepper(std::move(made.chain), limits);
  HandStep step;
  for (const PathRow& row : path) {
    HandInput hand{.time = row.time, .present = true};
    hand.sample = {row.time, workspace.workspace_from_data(row.position), row.buttons};
    step = stepper.step(hand);
    if (step.chain.jumped || step.state == HoldState::kFault) taken->append(Vec3{kNotThere}, 0.0);
    if (step.chain.links == 0) continue;
    view.probe = workspace.data_from_workspace(step.probe);
    view.proxy = workspace.data_from_workspace(step.chain.proxies[0]);
    view.force = glm::length(step.force);
    taken->append(view.proxy, view.force);
  }
  view.links = link_proxies(step.chain, workspace);
  if (options.show_path) view.path = PathView{taken, taken->size(), std::nullopt};
  if (scene.field) {
    CellHint hint;
    const VectorSample sample = scene.field->sample(view.proxy, hint);
    if (sample.status == SampleStatus::kOk) view.velocity = sample.value;
  }
  if (made.followed) {
    FollowedCurve curve(made.followed);
    curve.update(options.stream_balls ? ball_interval(*scene.field, workspace) : 0.0, style);
    view.followed = curve.drawn();
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
