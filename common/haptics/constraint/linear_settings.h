/// What can be edited of a linear constraint. Apart from linear.h, which needs all settings.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "common/base/index.h"
#include "common/haptics/axis_rule.h"
#include "common/haptics/transfer_function.h"

namespace palpate {

/// Whose directions the axes are (reference_frame.h, scalar_frame.h).
enum class LinearReference : std::uint8_t {
  kAuto,       ///< the flow where there is one, else the gradient
  kFlow,       ///< e_1 along the flow; the others are open
  kGradient,   ///< e_1 down the gradient of the scalar; the others are open
  kCurvature,  ///< e_1 as before, e_2 and e_3 along the larger and the smaller curvature of its isosurface
  kAxes        ///< the axes of the data, those of its grid where that is turned
};
inline constexpr int kLinearReferenceCount = 5;
[[nodiscard]] constexpr std::string_view name_of(LinearReference reference) noexcept {  ///< "curvature"
  constexpr std::array<std::string_view, kLinearReferenceCount> kNames{"auto", "flow", "gradient",
                                                                       "curvature", "axes"};
  return kNames[as_size(reference)];
}
/// Whether e_2 and e_3 may be turned about e_1 at will, so that both have to hold alike.
[[nodiscard]] constexpr bool leaves_axes_open(LinearReference reference) noexcept {
  return reference != LinearReference::kCurvature && reference != LinearReference::kAxes;
}

/// Whether it can be had of a flow alone.
[[nodiscard]] constexpr bool needs_flow(LinearReference reference) noexcept {
  return reference == LinearReference::kFlow;
}

/// What transfer functions take (measure.h).
enum class LinearMeasure : std::uint8_t {
  kValue,     ///< the scalar; of a flow its speed, unless another scalar was chosen
  kGradient,  ///< the steepness of that
  kSpeed,     ///< of the flow
  kAuto       ///< not chosen yet: it and the curves are made from the data (hand/mode/linear_proposal.h)
};
inline constexpr int kLinearMeasureCount = 4;
[[nodiscard]] constexpr std::string_view name_of(LinearMeasure measure) noexcept {  ///< "gradient"
  constexpr std::array<std::string_view, kLinearMeasureCount> kNames{"value", "gradient", "speed", "auto"};
  return kNames[as_size(measure)];
}

[[nodiscard]] constexpr bool needs_flow(LinearMeasure measure) noexcept {
  return measure == LinearMeasure::kSpeed;
}

/// One axis.
struct LinearAxis {
  AxisRule rule = AxisRule::kFree;
  HapticTransferFunction kappa{1.0};  ///< stiffness factor, in [0, 1]
  HapticTransferFunction tau{0.004};  ///< drag threshold [m], >= 0

  bool operator==(const LinearAxis&) const = default;

  [[nodiscard]] bool valid() const noexcept {
    return kappa.lowest() >= 0.0 && kappa.highest() <= 1.0 && tau.lowest() >= 0.0 &&
           std::isfinite(tau.highest());
  }
};

struct LinearSettings {
  std::array<LinearAxis, 3> axes;  ///< free, all of them
  /// Both take effect when the chain is built.
  LinearReference reference = LinearReference::kAuto;
  LinearMeasure measure = LinearMeasure::kValue;
  double friction = 0.0;         ///< growth of drag thresholds with what presses, >= 0 (axis_rule.h)
  double fade_distance = 0.002;  ///< way over which it lets go where the data ends [m], > 0

  bool operator==(const LinearSettings&) const = default;

  [[nodiscard]] bool valid() const noexcept {
    return axes[0].valid() && axes[1].valid() && axes[2].valid() && friction >= 0.0 &&
           std::isfinite(friction) && fade_distance > 0.0 && std::isfinite(fade_distance);
  }

  /// Whether a constraint that was built for `other` has to be built anew.
  [[nodiscard]] bool rebuilds(const LinearSettings& other) const noexcept {
    return reference != other.reference || measure != other.measure;
  }

  /// See ChainSettings::each().
  template <typename Self, typename Visit>
  static void each(Self& self, Visit&& visit) {
    visit("linear.reference", self.reference);
    visit("linear.measure", self.measure);
    visit("linear.1.rule", self.axes[0].rule);
    visit("linear.1.kappa", self.axes[0].kappa);
    visit("linear.1.tau", self.axes[0].tau);
    visit("linear.2.rule", self.axes[1].rule);
    visit("linear.2.kappa", self.axes[1].kappa);
    visit("linear.2.tau", self.axes[1].tau);
    visit("linear.3.rule", self.axes[2].rule);
    visit("linear.3.kappa", self.axes[2].kappa);
    visit("linear.3.tau", self.axes[2].tau);
    visit("linear.friction", self.friction);
    visit("linear.fade", self.fade_distance);
  }
};

}  // namespace palpate
