#include "common/calibration/fit_report.h"

#include <algorithm>
#include <cmath>

#include "common/base/error.h"
#include "common/base/text.h"

namespace palpate {

ErrorRow distance_row(const std::string& method, bool left_out, std::vector<double> metres) {
  for (double& e : metres) e *= 1e3;
  return {method, "distance", "mm", left_out, statistics_of(metres)};
}

ErrorStatistics statistics_of(std::span<const double> errors) {
  ErrorStatistics out{.count = errors.size()};
  if (errors.empty()) return out;
  const auto n = static_cast<double>(errors.size());
  double squares = 0.0;
  for (const double e : errors) {
    out.mean += e / n;
    squares += e * e / n;
    out.maximum = std::max(out.maximum, e);
  }
  out.rms = std::sqrt(squares);
  double spread = 0.0;
  for (const double e : errors) spread += (e - out.mean) * (e - out.mean);
  out.deviation = errors.size() > 1 ? std::sqrt(spread / (n - 1.0)) : 0.0;
  return out;
}

const ErrorRow* FitReport::find(const std::string& method, const std::string& quantity, bool left_out) const {
  for (const ErrorRow& row : errors) {
    if (row.method == method && row.quantity == quantity && row.left_out == left_out) return &row;
  }
  return nullptr;
}

double chi_square_tail(double value, std::size_t degrees) {
  if (degrees == 0) return 1.0;
  const double k = static_cast<double>(degrees), spread = 2.0 / (9.0 * k);
  const double normal = (std::cbrt(value / k) - (1.0 - spread)) / std::sqrt(spread);
  return 0.5 * std::erfc(normal / std::sqrt(2.0));
}

std::vector<std::size_t> outlying(std::span<const double> residuals, double floor) {
  if (residuals.empty()) return {};
  std::vector<double> sorted(residuals.begin(), residuals.end());
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  // The median length of a three-dimensional normal error is 1.54 deviations.
  constexpr double kMedianNorm = 1.54, kFarOut = 5.0;
  const double limit = std::max(floor, kFarOut * *middle / kMedianNorm);
  std::vector<std::size_t> rows;
  for (std::size_t i = 0; i < residuals.size(); ++i) {
    if (residuals[i] > limit) rows.push_back(i + 1);
  }
  return rows;
}

double residual_deviation(std::span<const double> residuals, std::size_t axes, std::size_t unknowns,
                          bool robust, double floor) {
  std::vector<std::size_t> apart;
  if (robust) apart = outlying(residuals, floor);
  double squares = 0.0;
  for (std::size_t i = 0; i < residuals.size(); ++i) {
    if (!std::ranges::binary_search(apart, i + 1)) squares += residuals[i] * residuals[i];
  }
  const std::size_t measured = axes * (residuals.size() - apart.size());
  return measured > unknowns ? std::sqrt(squares / static_cast<double>(measured - unknowns)) : NAN;
}

void require_identifiable(const Identifiability& found, const std::string& source,
                          const std::string& remedy) {
  if (found.condition_number < kSingularCondition) return;
  std::string parts;
  for (const WeakCombination& weak : found.weak) {
    if (weak.singular_value * kSingularCondition >= 1.0) break;
    parts += (parts.empty() ? "" : "; ") + described(weak);
  }
  throw input_error({.file = source,
                     .place = "",
                     .found = "these measurements cannot tell apart " + parts,
                     .expected = "",
                     .remedy = remedy});
}

void describe(FitReport& report, const Identifiability& found) {
  report.condition_number = found.condition_number;
  for (const WeakCombination& weak : found.weak) {
    report.weak.push_back(described(weak) + ": singular value " + short_number(weak.singular_value) +
                          " of the largest");
  }
}

}  // namespace palpate
