#include "common/haptics/constraint/linear.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/base/index.h"

namespace palpate {
namespace {

/// A motion below this is none [m]: 2e-7 N on the default spring, far below what any hand or device tells.
constexpr double kSettled = 1e-9;
/// Steps of one update. Where frames turn gently three do; where these do not settle, more do not either.
constexpr int kMostSteps = 16;

/// How much of the next motion to go, after `part` of the motion `before` has left the motion `now`: the
/// relaxation of Irons and Tuck (1969), which takes a row of ever smaller steps to its end, and stops steps
/// that go to and fro. Teeth are gone one by one.
double next_part(double part, const Vec3& before, const Vec3& now, const AxisHolds& holds) noexcept {
  for (const AxisHold& hold : holds) {
    if (hold.rule == AxisRule::kSnap) return 1.0;
  }
  const Vec3 change = now - before;
  const double squared = glm::dot(change, change);
  if (before == Vec3{0.0} || !(squared > 0.0)) return 1.0;
  constexpr double kLeast = 0.25, kMost = 2.0;  // beyond, a motion may lead away from the probe
  return std::clamp(-part * glm::dot(before, change) / squared, kLeast, kMost);
}

}  // namespace

LinearConstraint::LinearConstraint(std::unique_ptr<ReferenceFrame> frame,
                                   std::array<AxisMeasures, 3> measures)
    : frame_(std::move(frame)), measures_(std::move(measures)) {}

void LinearConstraint::reset() noexcept {
  caught_ = false;
  presence_ = 1.0;
  axes_ = {};
  frame_->forget();
}

/// Nothing where the measure has no value at the proxy.
std::optional<double> LinearConstraint::measured(SampledMeasure* measure,
                                                 const HapticTransferFunction& function) noexcept {
  if (measure == nullptr || function.constant()) return function(0.0);
  const ScalarSample sample = measure->at(proxy_);
  if (sample.status != SampleStatus::kOk) return std::nullopt;
  return function(sample.value);
}

/// Asks the data at the proxy for axes, thresholds and stiffness. Where it says nothing, those of the last
/// time stay, and this is false.
bool LinearConstraint::look() noexcept {
  const FrameSample axes = frame_->at(proxy_, axes_.axes);
  if (axes.status != SampleStatus::kOk) return false;
  AxisHolds holds;
  for (std::size_t a = 0; a < 3; ++a) {
    const LinearAxis& axis = settings_.axes[a];
    const auto tau = measured(measures_[a].tau.get(), axis.tau);
    const auto kappa = measured(measures_[a].kappa.get(), axis.kappa);
    if (!tau || !kappa) return false;
    holds[a] = {.rule = axis.rule, .tau = *tau, .kappa = *kappa};
  }
  make_alike(holds, 1, axes.split);
  make_alike(holds, 0, axes.certainty);
  axes_ = axes;
  holds_ = holds;
  return true;
}

void LinearConstraint::update(const Vec3& probe, const UpdateBudget& budget, LinkUpdate& link) noexcept {
  link.proxy = probe;
  if (!caught_) {
    proxy_ = last_probe_ = probe;
    presence_ = 1.0;
    if (!look()) {
      link.state = HoldState::kOutside;
      return;
    }
    caught_ = true;
  }
  const double way = glm::distance(probe, last_probe_) / settings_.fade_distance;
  last_probe_ = probe;

  const int most = std::min(budget.iterations, kMostSteps);
  AxisHolds holds;
  Vec3 before{0.0};
  double part = 1.0;
  link.jacobian = Mat3{0.0};
  for (;;) {
    const bool present = look();
    if (link.iterations == 0) presence_ = std::clamp(presence_ + (present ? way : -way), 0.0, 1.0);
    holds = holds_;
    let_go(holds, presence_);
    const AxisMotion motion = move_by_rules((probe - proxy_) * axes_.axes, holds, settings_.friction);
    const Vec3 moved = axes_.axes * motion.moved;
    part = next_part(part, before, moved, holds);
    before = moved;
    const Mat3 follows = axes_.axes * motion.jacobian * glm::transpose(axes_.axes);
    link.jacobian += part * follows * (Mat3{1.0} - link.jacobian);  // of this motion after those before
    link.residual = glm::length(moved);
    if (link.residual <= kSettled || link.iterations >= most) break;
    ++link.iterations;
    proxy_ += part * moved;
  }
  if (presence_ == 0.0) {
    reset();
    link.residual = 0.0;
    link.state = HoldState::kOutside;
    return;
  }
  link.proxy = proxy_;
  link.frame = axes_.axes;
  for (int a = 0; a < 3; ++a) link.kappa[a] = holds[as_size(a)].kappa;
  const bool certain = presence_ == 1.0 && axes_.certainty == 1.0;
  link.state = certain && link.residual <= kSettled ? HoldState::kHeld : HoldState::kFellBack;
}

}  // namespace palpate
