/// A shape of the workspace that holds a probe which comes near it: spheres, circles, segments and polylines,
/// of which widgets are made (Ikits 2006, sec. 6.6 and 8.6).
///
/// The proxy is the point of the shape nearest to the probe. Free motion and being held are two states: the
/// probe is caught within the snap distance, and let go where it is stretched beyond the release distance, so
/// that a hand at the edge does not flicker between the two.
#pragma once

#include "common/haptics/constraint.h"

namespace palpate {

/// The point of a shape nearest to a probe.
struct Foot {
  Vec3 point{0.0};      ///< [m]
  Mat3 axes{1.0};       ///< of the link, orthonormal
  Vec3 kappa{1.0};      ///< along them; below 1 next to where the nearest point leaps
  Mat3 jacobian{0.0};   ///< d point / d probe
  int iterations = 0;   ///< used
  bool certain = true;  ///< false: the budget ended the search, at a point of the shape all the same
};

class ShapeConstraint : public Constraint {
 public:
  void apply(const ChainSettings& settings) noexcept final { settings_ = settings.shape; }
  void reset() noexcept final;
  void update(const Vec3& probe, const UpdateBudget& budget, LinkUpdate& link) noexcept final;

 private:
  /// The nearest point of all, for a probe that is free. False while a search goes on over several updates.
  [[nodiscard]] virtual bool catch_foot(const Vec3& probe, int iterations, Foot& foot) noexcept = 0;
  /// The nearest point next to where the proxy was.
  virtual void follow_foot(const Vec3& probe, int iterations, Foot& foot) noexcept = 0;
  /// The probe is free again.
  virtual void forget() noexcept {}

  ShapeSettings settings_;
  bool held_ = false;
};

}  // namespace palpate
