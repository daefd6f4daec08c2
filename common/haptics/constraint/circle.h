/// A circle.
///
///   p = c + R u,   u = d / |d|,   d = (x - c) - ((x - c) . n) n,   J = (R / |d|) t t^T,   t = n x u      (1)
///
/// On the axis u has no direction: next to it the stiffness along u fades, over the inner quarter of the
/// radius, and the direction of the last step is kept where there is none. The pull along n stays.
#pragma once

#include "common/haptics/constraint/shape.h"

namespace palpate {

class CircleConstraint final : public ShapeConstraint {
 public:
  /// @param center c [m]  @param normal n, of any length but zero  @param radius R [m], > 0 and finite.
  CircleConstraint(const Vec3& center, const Vec3& normal, double radius);

 private:
  bool catch_foot(const Vec3& probe, int iterations, Foot& foot) noexcept override;
  void follow_foot(const Vec3& probe, int iterations, Foot& foot) noexcept override;

  Vec3 center_, normal_;
  double radius_;
  Vec3 outward_;  ///< u of the last step
};

}  // namespace palpate
