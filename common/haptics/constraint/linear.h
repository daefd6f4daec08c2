/// Linear constraints (Ikits 2006, sec. 6.3 to 6.5): a point, a line or a plane in an orthonormal frame of
/// the data, by a rule along each axis, with stiffness and drag that transfer functions take from the data.
///
///   x, p          probe, proxy                                                            [m]
///   e_a(p)        axes of the reference frame at the proxy
///   p <- p + sum_a e_a(p) dp_a,   dp = rules((x - p) . e_a(p))                            (eqs. 6.2 to 6.5)
///
/// The reference takes one such step an update. Where axes turn from place to place the proxy then goes on
/// moving under a hand at rest. Here steps are repeated until the rules at p move it no more, so that p is at
/// rest for any probe at rest. None of them leads away from x: rules are projections on to convex sets about
/// it, and the relaxation that makes steps few goes no more than twice as far. With a budget of one iteration
/// this is the step of the reference. It stays linear: along a line the proxy follows the tangents, and
/// drifts off the curve by the second order of each step (sec. 6.6 says so, and streamline.h does better).
/// Where the stretch is longer than the radius on which axes turn there may be no place at rest near by: the
/// state says so, and a drag rule in place of a fixed axis prevents it.
///
/// Axes that the frame leaves open have one rule: the second and third of a flow, or of a gradient, hold as
/// much as both rules agree on, so give them the same.
///
/// Where it fades. Uncertain axes become alike (make_alike()): what is held across an undefined direction is
/// let go, what is alike for all axes stays. Where the data ends, or is bad, the last frame stays and the
/// hold opens with the way that the probe goes on, over the fade distance; then the proxy is the probe until
/// there is data again. So with k the spring, R the largest stretch and frames that turn by theta and change
/// their reach by delta over a step dx, the force changes by at most k (|dx| + R theta + delta), kappa apart:
/// no place makes it jump. Teeth jump by one tooth.
///
/// J is that of the rules along the axes at p; how the axes turn and thresholds change with p is left out,
/// which is of the order of the stretch over the radius of curvature.
#pragma once

#include <array>
#include <memory>
#include <optional>

#include "common/haptics/constraint.h"
#include "common/haptics/measure.h"
#include "common/haptics/reference_frame.h"

namespace palpate {

/// What the transfer functions of an axis take; null where they are constant. One measure may serve several.
struct AxisMeasures {
  std::shared_ptr<SampledMeasure> kappa, tau;
};

class LinearConstraint final : public Constraint {
 public:
  /// @param frame of its own.  @param measures used by this constraint alone. Without one, a transfer
  /// function gives its value at zero.
  explicit LinearConstraint(std::unique_ptr<ReferenceFrame> frame, std::array<AxisMeasures, 3> measures = {});

  void apply(const ChainSettings& settings) noexcept override { settings_ = settings.linear; }
  void reset() noexcept override;
  void update(const Vec3& probe, const UpdateBudget& budget, LinkUpdate& link) noexcept override;

 private:
  [[nodiscard]] bool look() noexcept;
  [[nodiscard]] std::optional<double> measured(SampledMeasure* measure,
                                               const HapticTransferFunction& function) noexcept;

  std::unique_ptr<ReferenceFrame> frame_;
  std::array<AxisMeasures, 3> measures_;
  LinearSettings settings_;

  bool caught_ = false;
  Vec3 proxy_{0.0};
  Vec3 last_probe_{0.0};
  double presence_ = 1.0;  ///< falls from 1 to 0 over the fade distance where there is no data
  // What the data said at the proxy, where it last said something.
  FrameSample axes_;
  AxisHolds holds_{};
};

}  // namespace palpate
