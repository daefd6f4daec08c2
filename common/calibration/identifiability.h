/// Which parameters a set of measurements can tell apart.
///
/// The columns of the Jacobian are divided by their lengths, so that a unit of each parameter moves the
/// residuals by as much ("unit influence"); without this the condition number depends on whether angles are
/// written in degrees. Small singular values of the scaled matrix then belong to combinations of parameters
/// that hardly change any residual (Hollerbach and Wampler 1996; Ikits 2006, sec. 4.3.3: above 100 a fit is
/// not to be relied on).
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "common/calibration/least_squares.h"

namespace palpate {

/// Above this the reference's rule of thumb calls a fit unreliable.
inline constexpr double kReliableCondition = 100.0;
/// Above this parameters are not told apart at all: derivatives are good to about 1e-9.
inline constexpr double kSingularCondition = 1e7;

/// A direction of the scaled parameters that the measurements see badly.
struct WeakCombination {
  double singular_value = 0.0;                        ///< relative to the largest
  std::vector<std::pair<std::string, double>> parts;  ///< parameters and their share of it, largest first
};

struct Identifiability {
  double condition_number = 0.0;            ///< of the scaled columns; infinite where they are dependent
  double raw_condition_number = 0.0;        ///< of the columns as they are, in metres and radians
  std::vector<double> singular_values;      ///< scaled, largest first
  std::vector<double> standard_deviations;  ///< of each parameter for residuals of unit deviation
  std::vector<double> scales;               ///< the columns' lengths
  std::vector<double> weakest;              ///< right singular vector of the smallest singular value
  std::vector<WeakCombination> weak;        ///< those beyond kReliableCondition, weakest first
};

/// @param keep the first columns are asked about; the others (poses of single measurements) are estimated
/// along with them and taken out by projection. 0: all columns.
[[nodiscard]] Identifiability analyze(const Linearization& linearization, std::size_t keep = 0);

/// "gamma0 with gamma1 (0.71, 0.71)"
[[nodiscard]] std::string described(const WeakCombination& weak);

}  // namespace palpate
