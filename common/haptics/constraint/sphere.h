/// The surface of a sphere.
///
///   p = c + R n,   n = (x - c) / |x - c|,   J = (R / |x - c|) (1 - n n^T)                               (1)
///
/// At the centre n has no direction, and next to it p leaps to the other side: there kappa fades, over the
/// inner quarter of the radius, and the direction of the last step is kept where there is none. The pull
/// depends on |x - c| alone, so it stays conservative.
#pragma once

#include "common/haptics/constraint/shape.h"

namespace palpate {

class SphereConstraint final : public ShapeConstraint {
 public:
  /// @param center c [m]  @param radius R [m], > 0 and finite.
  SphereConstraint(const Vec3& center, double radius) : center_(center), radius_(radius) {}

 private:
  bool catch_foot(const Vec3& probe, int iterations, Foot& foot) noexcept override;
  void follow_foot(const Vec3& probe, int iterations, Foot& foot) noexcept override;

  Vec3 center_;
  double radius_;
  Vec3 normal_{1.0, 0.0, 0.0};  ///< n of the last step
};

}  // namespace palpate
