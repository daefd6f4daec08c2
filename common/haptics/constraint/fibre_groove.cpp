#include "common/haptics/constraint/fibre_groove.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/haptics/fade.h"
#include "common/haptics/frame_along.h"
#include "common/haptics/motion_rule.h"

namespace palpate {
namespace {

/// A motion below this is none [m].
constexpr double kNoDrag = 1e-9;
constexpr int kMostDragSteps = 24;
/// Longest step [m]: layers bend, and a faster hand is followed in several.
constexpr double kDragStride = 0.005;

/// A motion below this is none [m].
constexpr double kGrooveSettled = 1e-9;
constexpr int kGrooveSteps = 24;
/// Longest step [m]: fibres turn, and a faster hand is followed in several.
constexpr double kStride = 0.002;
/// Sine of the angle between fibre and layer normal from which on the groove has its full depth.
constexpr double kLying = 0.2;

}  // namespace

double FibreFriction::threshold(const FibreSample& at, const FibreSettings& settings) noexcept {
  const double u = std::min(1.0, std::abs(glm::dot(at.normal, at.fibre))) * fibre_certainty(at.gap);
  return (1.0 - u) * settings.least_friction + u * settings.most_friction;
}

void FibreFriction::update(const Vec3& probe, const UpdateBudget& budget, LinkUpdate& link) noexcept {
  link.proxy = probe;
  const SurfacePoint& asked = groove_.walk().point();
  if (!walk_.follow(asked, link)) return;
  const Workspace& workspace = walk_.surface().workspace();
  const double to_metres = workspace.local_scale();
  SearchWork work{.limit = budget.iterations};
  link.state = HoldState::kHeld;
  link.jacobian = Mat3{0.0};  // stuck
  bool rests = false;
  double stretch = 0.0;  // before this update [m]
  for (int step = 0; step < kMostDragSteps && !rests; ++step) {
    const FibreSample here = walk_.sample();
    if (here.status != SampleStatus::kOk || here.normal == Vec3{0.0}) {
      walk_.jump(asked);
      link.state = HoldState::kFellBack;
      rests = true;
      break;
    }
    threshold_ = threshold(here, settings_);
    link.frame = frame_along(workspace.turned(here.normal));
    link.kappa = {0.0, 1.0, 1.0};
    Vec3 r = asked.position - walk_.point().position;
    r -= glm::dot(r, here.normal) * here.normal;
    const double length = glm::length(r) * to_metres;
    const double go = length - threshold_;
    if (go <= kNoDrag) {
      rests = true;
      break;
    }
    if (stretch == 0.0) stretch = length;
    const Vec3 towards = r * (to_metres / length), u = workspace.turned(towards);
    const Vec3 n = link.frame[0];
    const Mat3 in_layer = Mat3{1.0} - glm::outerProduct(n, n);
    // Of all strides together: they follow one straight line as far as the layer is flat.
    link.jacobian = in_layer - (threshold_ / stretch) * (in_layer - glm::outerProduct(u, u));
    if (!walk_.move(towards * (std::min(go, kDragStride) / to_metres), work)) break;
  }
  if (!rests) link.state = HoldState::kFellBack;
  link.iterations = work.used;
  walk_.describe(link);
}

LayerWalk::LayerWalk(std::shared_ptr<const LayeredHeart> heart, const LayerConstraint& layer)
    : heart_(std::move(heart)), layer_(layer), search_(make_isosurface_search(heart_->heart().layer)) {}

bool LayerWalk::follow(const SurfacePoint& place, LinkUpdate& link) noexcept {
  if (surface().held_by() < 0) {
    caught_ = false;
    return false;
  }
  if (!caught_ || place.level != point_.level) {
    // Another layer: its own proxy has jumped, and this one goes with it.
    link.jumped = true;
    point_ = place;
    fit_ = {};
    caught_ = true;
  }
  return true;
}

bool LayerWalk::move(const Vec3& way, SearchWork& work) noexcept {
  fit_ = search_->settle(point_.position + way, point_, work);
  return fit_.end == SurfaceEnd::kClosest;
}

FibreSample LayerWalk::sample() noexcept {
  hint_.cell = point_.cell;
  return heart_->sample(point_.position, hint_);
}

void LayerWalk::describe(LinkUpdate& link) const noexcept {
  const Workspace& workspace = surface().workspace();
  link.proxy = workspace.workspace_from_local(point_.position);
  const double slope = glm::length(fit_.gradient);
  if (slope > 0.0) link.residual = std::abs(fit_.error) / slope * workspace.local_scale();
}

double fibre_certainty(double gap) noexcept {
  constexpr double kFullGap = 0.1;
  return fade(gap / kFullGap);
}

void FibreGroove::update(const Vec3& probe, const UpdateBudget& budget, LinkUpdate& link) noexcept {
  link.proxy = probe;
  const SurfacePoint& asked = walk_.surface().point();
  if (!walk_.follow(asked, link)) return;
  const double to_metres = walk_.surface().workspace().local_scale();
  SearchWork work{.limit = budget.iterations};
  link.state = HoldState::kHeld;
  bool rests = false;
  for (int step = 0; step < kGrooveSteps && !rests; ++step) {
    const FibreSample here = walk_.sample();
    if (here.status != SampleStatus::kOk || here.normal == Vec3{0.0}) {
      walk_.jump(asked);
      link.state = HoldState::kFellBack;
      rests = true;
      break;
    }
    Vec3 r = asked.position - walk_.point().position;
    r -= glm::dot(r, here.normal) * here.normal;
    const double certainty = fibre_certainty(here.gap) * fade(here.tangential / kLying);
    // One narrower than the proxy comes to rest is none: as far as the layer's proxy. So rounding has no say
    // in which way a fibre that stands on the layer lies in it.
    if (spacing_ * certainty <= kGrooveSettled) {
      link.jacobian = Mat3{1.0} - glm::outerProduct(here.normal, here.normal);
      link.kappa = Vec3{0.0};
      const double length = glm::length(r) * to_metres;
      if (length <= kGrooveSettled) rests = true;
      if (rests || !walk_.move(r * std::min(1.0, kStride / length), work)) break;
      continue;
    }
    const Vec3 t = here.in_layer, c = glm::cross(here.normal, t);
    const Workspace& workspace = walk_.surface().workspace();
    link.frame = {workspace.turned(t), workspace.turned(c), workspace.turned(here.normal)};
    link.kappa = {0.0, 1.0, 0.0};
    link.jacobian = glm::outerProduct(link.frame[0], link.frame[0]);
    const double along = glm::dot(r, t) * to_metres;
    const double across = snap_drag(glm::dot(r, c) * to_metres, spacing_ * certainty);
    if (std::abs(across) > 0.0) {
      if (!walk_.move(c * (across / to_metres), work)) break;
      continue;
    }
    if (std::abs(along) <= kGrooveSettled) {
      rests = true;
      break;
    }
    const double go = std::clamp(along, -kStride, kStride) / to_metres;
    const SurfacePoint from = walk_.point();
    if (!walk_.move(0.5 * go * t, work)) break;
    const FibreSample half = walk_.sample();
    walk_.jump(from);
    Vec3 direction = t;
    if (half.status == SampleStatus::kOk && half.in_layer != Vec3{0.0})
      direction = glm::dot(half.in_layer, t) < 0.0 ? -half.in_layer : half.in_layer;
    if (!walk_.move(go * direction, work)) break;
  }
  if (!rests) link.state = HoldState::kFellBack;
  link.iterations = work.used;
  walk_.describe(link);
}

}  // namespace palpate
