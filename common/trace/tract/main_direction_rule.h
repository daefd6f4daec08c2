/// When the iteration for a main eigenvector ends, and what certifies it: main_direction.h and the kernels of
/// quad_kernel.h keep to the same rule.
#pragma once

namespace palpate::direction_rule {

inline constexpr int kMostSteps = 4;
inline constexpr double kTurnDone = 1e-6;  ///< squared sine of the last step's turn: what is left is its cube
inline constexpr double kLeastGap = 1e-6;  ///< squared, of the eigenvalues' sum: below it two of them are one

}  // namespace palpate::direction_rule
