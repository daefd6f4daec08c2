/// Units that users see, and those that the code computes in.
#pragma once

namespace palpate {

/// Options of the hand are in millimetres, the workspace in metres.
inline constexpr double kMetresPerMillimetre = 1e-3;

}  // namespace palpate
