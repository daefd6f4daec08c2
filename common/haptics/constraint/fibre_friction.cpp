#include "common/haptics/constraint/fibre_friction.h"

#include <algorithm>
#include <cmath>

#include "common/haptics/frame_along.h"

namespace palpate {
namespace {

/// A motion below this is none [m].
constexpr double kNoDrag = 1e-9;
constexpr int kMostDragSteps = 24;
/// Longest step [m]: layers bend, and a faster hand is followed in several.
constexpr double kDragStride = 0.005;

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

}  // namespace palpate
