/// A haptic grid (Ikits 2006, sec. 8.5): the probe is led along one axis of a regular grid, until it is
/// pulled far enough towards another one, which then takes over at the nearest node.
///
/// With u the coordinates of the probe in the grid, metres from its origin along its axes, h the spacings and
/// a the axis that leads, the proxy is at
///
///   q_a = u_a,   q_b = its node's, for b != a                                                          (1)
///
/// When |u_b - q_b| of some b exceeds the threshold while u_a is within the threshold of a node, q_a goes to
/// that node and b leads: here the force leaps, and the safety stage begins anew. Elsewhere along the axis a
/// pull across changes nothing: an axis left there would pull back at once, for ever.
///
/// With teeth, q_a stays on nodes, from one to the next by the snap-drag rule with tau = h_a: landmarks that
/// are felt where an axis can be left.
#pragma once

#include "common/haptics/constraint.h"

namespace palpate {

class GridAxis final : public Constraint {
 public:
  /// @param origin a node [m]  @param axes orthonormal, columns  @param spacing h [m], > 0 along each axis.
  GridAxis(const Vec3& origin, const Mat3& axes, const Vec3& spacing)
      : origin_(origin), axes_(axes), spacing_(spacing) {}

  void apply(const ChainSettings& settings) noexcept override { settings_ = settings.grid_axis; }
  void reset() noexcept override { caught_ = false; }
  void update(const Vec3& probe, const UpdateBudget& budget, LinkUpdate& link) noexcept override;

  /// The axis that leads: 0, 1 or 2.
  [[nodiscard]] int leading() const noexcept { return leading_; }

 private:
  [[nodiscard]] double node(int axis, double u) const noexcept;
  void catch_at(const Vec3& u) noexcept;
  [[nodiscard]] bool change_over(const Vec3& u) noexcept;

  Vec3 origin_;
  Mat3 axes_;
  Vec3 spacing_;
  GridAxisSettings settings_;
  bool caught_ = false;
  int leading_ = 0;
  Vec3 at_{0.0};  ///< q; along the axis that leads, the tooth
};

}  // namespace palpate
