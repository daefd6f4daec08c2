#include "lab/hand/chain/chain_rivals.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <numbers>
#include <utility>

#include "common/base/index.h"
#include "common/field/analytic/volume_examples.h"
#include "common/haptics/constraint/isosurface.h"
#include "common/haptics/constraint/streamline.h"
#include "common/haptics/proxy_chain.h"
#include "lab/data/formula_flow.h"
#include "lab/hand/chain/rivals.h"
#include "lab/hand/streamline_run.h"

namespace palpate {
namespace {

constexpr double kScale = 0.1;          // m a unit of data
constexpr double kSphereRadius = 0.06;  // m, about the origin
constexpr double kCircleRadius = 0.08;  // m
constexpr double kBefore = 0.015;       // m of way before the surface
constexpr double kHandStep = 1e-4;      // m: 0.1 m/s at 1 kHz
constexpr double kAside = 0.0015;       // m, of the hand from the circle, at most

/// The circle that enters the sphere at (R, 0, 0), and a hand that follows it.
class Scene {
 public:
  explicit Scene(double degrees) : angle_(degrees * std::numbers::pi / 180.0) {
    const Vec3 entry{kSphereRadius, 0.0, 0.0};
    to_entry_ = Vec3{std::sin(angle_), std::cos(angle_), 0.0};
    center_ = entry - kCircleRadius * to_entry_;
    const Vec3 c = center_ / kScale;
    flow_ = make_vector_field(std::make_shared<const FormulaFlow>(
        [c](const Vec3& x) {
          return Vec3{c.y - x.y, x.x - c.x, 0.0};
        },
        [](const Vec3&) { return Mat3{0.0, 1.0, 0.0, -1.0, 0.0, 0.0, 0.0, 0.0, 0.0}; },
        Box{Vec3{-3.0}, Vec3{3.0}}));
    scalar_ = make_scalar_field(sphere_scalar());
  }

  [[nodiscard]] const std::shared_ptr<const VectorField>& flow() const noexcept { return flow_; }
  [[nodiscard]] const std::shared_ptr<const ScalarField>& scalar() const noexcept { return scalar_; }
  [[nodiscard]] Workspace flow_workspace() const { return {kScale, flow_->frame()}; }
  [[nodiscard]] Workspace scalar_workspace() const { return {kScale, scalar_->frame()}; }
  [[nodiscard]] static double isovalue() { return (kSphereRadius / kScale) * (kSphereRadius / kScale); }

  /// A place at `way` along the circle from where it enters, `aside` from it.
  [[nodiscard]] Vec3 at(double way, double aside = 0.0) const {
    const double turn = way / kCircleRadius, c = std::cos(turn), s = std::sin(turn);
    return center_ + (kCircleRadius + aside) *
                         Vec3{c * to_entry_.x - s * to_entry_.y, s * to_entry_.x + c * to_entry_.y, 0.0};
  }
  [[nodiscard]] double from_circle(const Vec3& x) const {
    const Vec3 away = x - center_;
    return std::hypot(std::hypot(away.x, away.y) - kCircleRadius, away.z);
  }
  [[nodiscard]] static double depth(const Vec3& x) { return kSphereRadius - glm::length(x); }
  /// The hand at `way`: on one side of the circle, then on the other.
  [[nodiscard]] Vec3 hand(double way) const {
    return at(way, kAside * std::cos(2.0 * std::numbers::pi * way / 0.02));
  }
  /// The way by which the circle is at twice the depth limit: there the path ends.
  [[nodiscard]] double way_in() const {
    double way = 0.0;
    constexpr double kLongest = 0.08;
    while (way < kLongest && depth(at(way)) < 2.0 * kDepthLimit) way += kHandStep;
    return way;
  }

 private:
  double angle_;
  Vec3 to_entry_{0.0}, center_{0.0};
  std::shared_ptr<const VectorField> flow_;
  std::shared_ptr<const ScalarField> scalar_;
};

using Links = std::vector<std::unique_ptr<Constraint>>;

Links links_of(const Scene& scene) {
  Links links;
  links.push_back(std::make_unique<StreamlineConstraint>(
      std::make_shared<LiveLine>(scene.flow(), LiveLine::kFollowTolerance, 1), scene.flow_workspace()));
  links.push_back(std::make_unique<IsosurfaceConstraint>(scene.scalar(), scene.scalar_workspace()));
  return links;
}

/// The streamline does not let go on these paths: what is compared is the surface.
ChainSettings settings_with_depth(double depth) {
  ChainSettings settings;
  settings.streamline.release_distance = 0.05;
  settings.isosurface.isovalues.count = 1;
  settings.isosurface.isovalues.value[0] = Scene::isovalue();
  settings.isosurface.depth = depth;
  return settings;
}

/// A method: what it makes of the hand's next place.
using Method = std::function<void(RivalStep&)>;

Method make_chain(const Scene& scene) {
  const auto chain = std::make_shared<ProxyChain>(links_of(scene), settings_with_depth(kDepthLimit));
  return [chain, was_deep = false, on = true](RivalStep& step) mutable {
    const ChainStep now = chain->step(step.probe);
    step.curve_proxy = now.proxies[0];
    step.surface_proxy = now.proxies[1];
    step.cue = glm::distance(now.proxies[1], now.proxies[0]);
    on = on && !(was_deep && step.cue == 0.0 && step.depth > 0.0);
    was_deep = step.cue > 0.0;
    step.surface_on = on;
  };
}

Method make_pipe(const Scene& scene) {
  // The surface itself would let go only far behind: the pipe does, by its own stretch.
  constexpr double kNever = 1.0;
  const auto pipe = std::make_shared<ConstraintPipe>(
      links_of(scene),
      ConstraintPipeSettings{.chain = settings_with_depth(kNever), .release_distance = kDepthLimit});
  return [pipe](RivalStep& step) {
    const ConstraintPipeStep now = pipe->step(step.probe);
    step.curve_proxy = step.surface_proxy = now.proxy;
    step.cue = glm::distance(now.proxy, step.probe);
    step.surface_on = !now.released;
  };
}

/// @param curve, surface strengths [N]
Method make_balance(const Scene& scene, double curve, double surface) {
  struct State {
    Vec3 proxy{0.0};
    bool begun = false, surface_on = true;
    CellHint flow_hint, scalar_hint;
  };
  const auto state = std::make_shared<State>();
  return [=, &scene](RivalStep& step) {
    if (!state->begun) state->proxy = step.probe;
    state->begun = true;
    const Vec3 here = state->proxy / kScale;
    // What the data says at the last proxy: direction of the flow, and the surface by its gradient.
    const Vec3 along = glm::normalize(scene.flow()->sample(here, state->flow_hint).value);
    const Vec3 gradient = scene.scalar()->gradient(here, state->scalar_hint).value;
    const double value = scene.scalar()->sample(here, state->scalar_hint).value;
    const double slope = glm::length(gradient);
    const Vec3 on_surface =
        state->proxy + kScale * ((Scene::isovalue() - value) / (slope * slope)) * gradient;
    const std::array both{
        HapticPrimitive{HapticPrimitive::Kind::kLine, state->proxy, along, curve},
        HapticPrimitive{HapticPrimitive::Kind::kPlane, on_surface, gradient / slope, surface}};
    state->proxy = balanced_proxy(step.probe, ChainSettings{}.stiffness,
                                  std::span(both).first(state->surface_on ? 2 : 1));
    state->surface_on = state->surface_on && Scene::depth(state->proxy) <= kDepthLimit;
    step.curve_proxy = step.surface_proxy = state->proxy;
    step.cue = glm::distance(state->proxy, step.probe);
    step.surface_on = state->surface_on;
  };
}

Method make_method(RivalMethod method, const Scene& scene) {
  // The strength of what is weaker: the force of the coupling at the depth limit, where a chain lets go.
  const double strength = ChainSettings{}.stiffness * kDepthLimit;
  switch (method) {
    case RivalMethod::kPipe:
      return make_pipe(scene);
    case RivalMethod::kBalanceCurve:
      return make_balance(scene, 2.0 * strength, strength);
    case RivalMethod::kBalanceSurface:
      return make_balance(scene, strength, 2.0 * strength);
    default:
      return make_chain(scene);
  }
}

void judge(const Scene& scene, RivalRun& run) {
  bool was_on = true;
  for (const RivalStep& step : run.steps) {
    const double off = scene.from_circle(step.curve_proxy);
    run.curve_drift = std::max(run.curve_drift, off);
    if (step.surface_on) {
      run.surface_drift = std::max(run.surface_drift, Scene::depth(step.surface_proxy));
      if (step.depth > 0.0) run.cue_error = std::max(run.cue_error, std::abs(step.cue - step.depth));
    } else {
      if (was_on) run.release_depth = step.depth;
      run.drift_after = std::max(run.drift_after, off);
    }
    was_on = step.surface_on;
  }
}

RivalRun measure(RivalMethod method, double angle) {
  const Scene scene(angle);
  const Method move = make_method(method, scene);
  RivalRun run{.method = method, .angle = angle};
  const double end = scene.way_in();
  const int steps = static_cast<int>(std::ceil((end + kBefore) / kHandStep));
  for (int n = 0; n < steps; ++n) {
    const double way = kHandStep * n - kBefore;
    RivalStep step{.probe = scene.hand(way), .depth = Scene::depth(scene.at(way))};
    const double before = thread_microseconds();
    move(step);
    run.us_mean += thread_microseconds() - before;
    run.steps.push_back(step);
  }
  run.us_mean /= static_cast<double>(run.steps.size());
  judge(scene, run);
  return run;
}

}  // namespace

std::string_view name_of(RivalMethod method) noexcept {
  constexpr std::array<std::string_view, kRivalMethods.size()> kNames{"chain", "pipe", "balance, curve",
                                                                      "balance, surface"};
  return kNames[as_size(method)];
}

std::vector<RivalRun> run_chain_rivals(Progress* progress) {
  if (progress) progress->begin("chain, pipe and balance", 0);
  std::vector<RivalRun> runs;
  for (const double angle : kRivalAngles) {
    for (const RivalMethod method : kRivalMethods) {
      if (progress) progress->check();
      runs.push_back(measure(method, angle));
    }
  }
  return runs;
}

}  // namespace palpate
