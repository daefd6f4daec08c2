/// A haptic grid (Ikits 2006, sec. 8.5): the probe is led along one axis of a regular grid, until it is
/// pulled far enough towards another one, which then takes over at the nearest node or landmark.
///
/// With u the coordinates of the probe in the grid, metres from its origin along its axes, h the spacings and
/// a the axis that leads, the proxy is at
///
///   q_a = u_a,   q_b = its node's, for b != a                                                          (1)
///
/// When |u_b - q_b| of some b exceeds the threshold while u_a is within the threshold of a node or landmark,
/// q_a goes there and b leads: here the force leaps, and the safety stage begins anew. Elsewhere along the
/// axis a pull across changes nothing: an axis left there would pull back at once, for ever. Along an axis
/// that does not lead q keeps its very bits.
///
/// With detents, q_a stays on nodes, from one to the next by the snap-drag rule with tau = h_a.
///
/// Landmarks are planes m_i . q = c_i, felt where the axis that leads crosses them, at
/// l_i = (c_i - sum_(b != a) m_ib q_b) / m_ia, as notches of half-width w:
///
///   q_a = l_i  and  kappa_a = (1 - (d/w)^2)^2   for d = |u_a - l_i| < w                                (2)
///
/// The pull k kappa_a d is that of a potential, is zero at both ends and so never leaps. Next to another
/// landmark w ends halfway.
#pragma once

#include <array>
#include <span>

#include "common/haptics/constraint.h"

namespace palpate {

class GridAxis final : public Constraint {
 public:
  static constexpr int kMaxLandmarks = GridMarks::kMax + 3 * GridAxisSettings::kMostPeaks;
  /// m . x = c in the workspace.
  struct Landmark {
    Vec3 normal{0.0};     ///< m, unit
    double offset = 0.0;  ///< c [m]
  };

  /// @param origin a node [m]  @param axes orthonormal, columns  @param spacing h [m], > 0 along each axis.
  /// @pre at most kMaxLandmarks landmarks.
  GridAxis(const Vec3& origin, const Mat3& axes, const Vec3& spacing,
           std::span<const Landmark> landmarks = {});

  void apply(const ChainSettings& settings) noexcept override { settings_ = settings.grid_axis; }
  void reset() noexcept override { caught_ = false; }
  void update(const Vec3& probe, const UpdateBudget& budget, LinkUpdate& link) noexcept override;

  /// The axis that leads: 0, 1 or 2. Tests hold the rule of changing over to its landmarks, by this.
  [[nodiscard]] int leading() const noexcept { return leading_; }
  /// q [m] in the grid.
  [[nodiscard]] const Vec3& position() const noexcept { return at_; }

 private:
  /// The landmark next to a place along the axis that leads, and how far it reaches.
  struct Notch {
    bool there = false;
    double at = 0.0;     ///< l [m]
    double reach = 0.0;  ///< w [m]
  };
  [[nodiscard]] double node(int axis, double u) const noexcept;
  [[nodiscard]] Notch notch_near(double u) const noexcept;
  void catch_at(const Vec3& u) noexcept;
  [[nodiscard]] bool change_over(const Vec3& u) noexcept;

  Vec3 origin_;
  Mat3 axes_;
  Vec3 spacing_;
  std::array<Landmark, kMaxLandmarks> landmarks_{};  ///< in the grid: m . q = c
  int landmark_count_ = 0;
  GridAxisSettings settings_;
  bool caught_ = false;
  int leading_ = 0;
  Vec3 at_{0.0};  ///< q; along the axis that leads, the tooth
};

}  // namespace palpate
