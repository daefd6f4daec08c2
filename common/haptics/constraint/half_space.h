/// A wall: the probe is free on one side of a plane, and the proxy stays on it.
///
///   p = x - min(0, d) n,   d = (x - o) . n,   J = 1 - n n^T where d < 0, else 1                         (1)
///
/// n points out of the wall, into the free space (what eq. 6.7 of Ikits 2006 calls the positive side). The
/// force is that of eq. 6.7 without a threshold: continuous, and never a pull.
#pragma once

#include <algorithm>

#include "common/base/check.h"
#include "common/haptics/constraint.h"
#include "common/haptics/constraint/touched_surface.h"
#include "common/haptics/frame_along.h"

namespace palpate {

class HalfSpaceConstraint final : public Constraint, public TouchedSurface {
 public:
  /// @param point o on the plane [m]  @param outward n, not zero.
  HalfSpaceConstraint(const Vec3& point, const Vec3& outward)
      : point_(point), axes_(frame_along(glm::normalize(outward))) {
    PALPATE_CHECK(glm::length(outward) > 0.0);
  }

  void apply(const ChainSettings& /*settings*/) noexcept override {}
  void reset() noexcept override { depth_ = 0.0; }
  void update(const Vec3& probe, const UpdateBudget& budget, LinkUpdate& link) noexcept override;
  [[nodiscard]] SurfaceContact contact() const noexcept override {
    return {.touches = depth_ > 0.0, .depth = depth_, .normal = axes_[0]};
  }

 private:
  Vec3 point_;
  Mat3 axes_;           ///< n first
  double depth_ = 0.0;  ///< of the probe [m]
};

inline void HalfSpaceConstraint::update(const Vec3& probe, const UpdateBudget& /*budget*/,
                                        LinkUpdate& link) noexcept {
  const Vec3& outward = axes_[0];
  const double depth = std::min(0.0, glm::dot(probe - point_, outward));
  link.proxy = probe - depth * outward;
  link.frame = axes_;
  link.crossed = (depth < 0.0) != (depth_ > 0.0);
  depth_ = -depth;
  if (!(depth < 0.0)) return;
  link.state = HoldState::kHeld;
  link.jacobian = Mat3{1.0} - glm::outerProduct(outward, outward);
}

}  // namespace palpate
