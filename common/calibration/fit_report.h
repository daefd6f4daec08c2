/// What every calibration reports.
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "common/base/work_precision.h"
#include "common/calibration/least_squares.h"

namespace palpate {

// Which parameters a set of measurements can tell apart.
//
// The columns of the Jacobian are divided by their lengths, so that a unit of each parameter moves the
// residuals by as much ("unit influence"); without this the condition number depends on whether angles are
// written in degrees. Small singular values of the scaled matrix then belong to combinations of parameters
// that hardly change any residual (Hollerbach and Wampler 1996; Ikits 2006, sec. 4.3.3: above 100 a fit is
// not to be relied on).

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

struct ErrorStatistics {
  std::size_t count = 0;
  double mean = 0.0, deviation = 0.0, maximum = 0.0, rms = 0.0;
};

[[nodiscard]] ErrorStatistics statistics_of(std::span<const double> errors);

/// A row of table 4.1: one quantity under one method.
struct ErrorRow {
  std::string method;     ///< "before", "offsets alone", "polynomial, degree 4"
  std::string quantity;   ///< "position", "orientation", "distance"
  std::string unit;       ///< "mm", "deg"
  bool left_out = false;  ///< on measurements that the fit did not see
  ErrorStatistics errors;
};

struct FittedParameter {
  std::string name;
  double value = 0.0;
  double deviation = 0.0;  ///< standard, from the residuals; NaN where it is not known
  std::string unit;        ///< "m", "rad", "1"
};

/// An error against the place where it was made, for pictures.
struct PlacedError {
  double distance = 0.0;  ///< from the transmitter [m]
  double before = 0.0, after = 0.0;
};

struct FitReport {
  std::string kind;    ///< "tracker", "arm", …
  std::string source;  ///< the file of measurements, or "example"
  std::size_t measurements = 0;
  std::vector<ErrorRow> errors;
  double condition_number = 0.0;  ///< columns scaled to unit influence
  std::optional<double> chi_square;
  std::size_t degrees_of_freedom = 0;
  double chi_square_probability = 0.0;  ///< of a larger one by chance
  int iterations = 0;
  std::vector<FittedParameter> parameters;
  std::vector<std::string> weak;      ///< parameters that the measurements hardly tell apart
  std::vector<std::string> advice;    ///< where to measure next, and what else the user should know
  std::vector<std::size_t> outliers;  ///< rows of the table, from 1
  std::vector<WorkPrecision> work_precision;
  std::vector<PlacedError> position_errors, orientation_errors;  ///< [m], [rad]; left-out measurements
  double seconds = 0.0;

  /// @return null where there is no such row.
  [[nodiscard]] const ErrorRow* find(const std::string& method, const std::string& quantity,
                                     bool left_out) const;
};

/// Probability that chi-square with `degrees` of freedom exceeds `value` (Wilson and Hilferty 1931: good to
/// three digits from ten degrees on).
[[nodiscard]] double chi_square_tail(double value, std::size_t degrees);

/// Rows whose residual lies more than five robust deviations out, from 1. A fit that is exact has none.
/// @param floor residuals below it are never outliers.
[[nodiscard]] std::vector<std::size_t> outlying(std::span<const double> residuals, double floor);

/// Standard deviation of a measurement's error along one axis, by the lengths of what the fit left of each.
/// @param axes that each tells of  @param unknowns that were fitted  @param robust the loss was one that
/// takes outlying() measurements for errors of another kind: they tell nothing of the others' noise.
/// @return NaN where as much was fitted as was measured.
[[nodiscard]] double residual_deviation(std::span<const double> residuals, std::size_t axes,
                                        std::size_t unknowns, bool robust, double floor);

/// Refuses measurements whose linearized problem is singular.
/// @param source file; @param remedy what to measure next. @throws Error (bad input).
void require_identifiable(const Identifiability& found, const std::string& source, const std::string& remedy);

/// A row of a report: statistics of distances, in millimetres. @param metres one a measurement [m].
[[nodiscard]] ErrorRow distance_row(const std::string& method, bool left_out, std::vector<double> metres);

/// Fills in condition number and weak combinations.
void describe(FitReport& report, const Identifiability& found);

/// Errors on each measurement by a fit that did not see it: measurement i is left out of fit i mod folds.
/// @param fit takes the kept measurements; @param error takes what it gave and a measurement.
template <typename Measurement, typename Fit, typename Error>
[[nodiscard]] auto left_out_errors(const std::vector<Measurement>& all, std::size_t folds, const Fit& fit,
                                   const Error& error) {
  using Value = decltype(error(fit(all), all[0]));
  std::vector<Value> out(all.size());
  for (std::size_t fold = 0; fold < folds && fold < all.size(); ++fold) {
    std::vector<Measurement> kept;
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (i % folds != fold) kept.push_back(all[i]);
    }
    const auto fitted = fit(kept);
    for (std::size_t i = fold; i < all.size(); i += folds) out[i] = error(fitted, all[i]);
  }
  return out;
}

}  // namespace palpate
