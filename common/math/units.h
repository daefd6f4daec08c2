/// Units that users see, and those that the code computes in.
#pragma once

#include <numbers>

namespace palpate {

/// Options of the hand are in millimetres, the workspace in metres.
inline constexpr double kMetresPerMillimetre = 1e-3;

/// Angles of options and reports are in degrees.
inline constexpr double kDegreesARadian = 180.0 / std::numbers::pi,
                        kRadiansADegree = std::numbers::pi / 180.0;

}  // namespace palpate
