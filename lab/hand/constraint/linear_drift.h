/// How far a proxy drifts from the line that it set out on: the linear model of sec. 6.3 against the
/// streamline constraint of sec. 6.6 (Ikits 2006, figure 6.5).
///
/// A hand follows a line that is known in closed form, at a steady speed, in steps of 1 ms. Its proxy is held
/// by
///
///   linear step      p <- p + t (t . (x - p)),  t = v(p) / |v(p)|: eqs. 6.12 and 6.13, a step of Euler's (1)
///   linear, settled  (1) repeated until it moves the proxy no more (constraint/linear.h) (2) streamline the
///   nearest point of the line itself                                                 (3)
///
/// What is measured is the largest distance of the proxy from the line, which the constraints know nothing
/// of. On lines that part (v = (1, r y, 0), y = y0 exp(r x)) the divergence r lets every error grow; on
/// circles the curvature makes it.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/progress.h"
#include "lab/page/section.h"

namespace palpate {

enum class FollowMethod : std::uint8_t { kLinearStep, kLinearSettled, kStreamline };
inline constexpr std::array<FollowMethod, 3> kFollowMethods{
    FollowMethod::kLinearStep, FollowMethod::kLinearSettled, FollowMethod::kStreamline};
[[nodiscard]] std::string_view name_of(FollowMethod method) noexcept;

enum class DriftFlow : std::uint8_t { kParting, kTurning };
[[nodiscard]] std::string_view name_of(DriftFlow flow) noexcept;  ///< "lines that part"

struct LinearDriftRow {
  DriftFlow flow = DriftFlow::kParting;
  FollowMethod method = FollowMethod::kLinearStep;
  double rate = 0.0;     ///< divergence, or curvature of the circle [1/m]
  double speed = 0.0;    ///< of the hand [m/s]
  double drift = 0.0;    ///< [m]
  double us_mean = 0.0;  ///< of a step, processor time
};

struct LinearDrift {
  std::vector<LinearDriftRow> by_speed;  ///< at kDriftRate
  std::vector<LinearDriftRow> by_rate;   ///< at kDriftSpeed
};
inline constexpr double kDriftRate = 20.0;  ///< [1/m]
inline constexpr double kDriftSpeed = 0.2;  ///< [m/s]
inline constexpr double kDriftWay = 0.2;    ///< that the hand goes along the line [m]

/// @throws Cancelled.
[[nodiscard]] LinearDrift run_linear_drift(Progress* progress);

[[nodiscard]] ReportSection linear_drift_section(const LinearDrift& drift);

}  // namespace palpate
