#include "common/calibration/fit_report.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Dense>

#include "common/base/check.h"
#include "common/base/error.h"
#include "common/base/index.h"
#include "common/base/text.h"

namespace palpate {
namespace {

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

double ratio(const Eigen::VectorXd& values) {
  const double least = values(values.size() - 1);
  return least > 0.0 ? values(0) / least : std::numeric_limits<double>::infinity();
}

/// An upper triangle with the singular values of the kept columns, others projected out.
Eigen::MatrixXd condensed(const Linearization& in, std::size_t keep) {
  const Eigen::Map<const RowMajor> all(in.jacobian.data(), static_cast<Eigen::Index>(in.rows),
                                       static_cast<Eigen::Index>(in.columns));
  const auto kept = static_cast<Eigen::Index>(keep), rest = all.cols() - kept;
  Eigen::MatrixXd ordered(all.rows(), all.cols());
  ordered << all.rightCols(rest), all.leftCols(kept);
  // With the nuisance columns first, the last rows of R are what they leave of the kept ones.
  const Eigen::MatrixXd r = Eigen::HouseholderQR<Eigen::MatrixXd>(ordered).matrixQR();
  const Eigen::Index rows = std::min(r.rows(), r.cols());
  if (rows - rest < kept) return Eigen::MatrixXd::Zero(kept, kept);
  return r.block(rest, rest, kept, kept).triangularView<Eigen::Upper>();
}

}  // namespace

Identifiability analyze(const Linearization& in, std::size_t keep) {
  if (keep == 0) keep = in.columns;
  PALPATE_CHECK(keep <= in.columns);
  Eigen::MatrixXd r = condensed(in, keep);
  Identifiability out;
  out.raw_condition_number = ratio(Eigen::JacobiSVD<Eigen::MatrixXd>(r).singularValues());
  for (Eigen::Index c = 0; c < r.cols(); ++c) {
    const double length = r.col(c).norm();
    out.scales.push_back(length);
    if (length > 0.0) r.col(c) /= length;
  }
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(r, Eigen::ComputeThinV);
  const Eigen::VectorXd& s = svd.singularValues();
  const Eigen::MatrixXd& v = svd.matrixV();
  out.condition_number = ratio(s);
  out.singular_values.assign(s.data(), s.data() + s.size());
  const Eigen::Index last = s.size() - 1;
  out.weakest.assign(v.col(last).data(), v.col(last).data() + v.rows());

  for (Eigen::Index c = 0; c < v.rows(); ++c) {
    double variance = 0.0;
    for (Eigen::Index k = 0; k < s.size(); ++k) variance += std::pow(v(c, k) / s(k), 2);
    out.standard_deviations.push_back(std::sqrt(variance) / out.scales[as_size(c)]);
  }
  for (Eigen::Index k = last; k >= 0 && s(k) * kReliableCondition < s(0); --k) {
    WeakCombination weak{.singular_value = s(k) / s(0), .parts = {}};
    for (Eigen::Index c = 0; c < v.rows(); ++c) {
      constexpr double kWorthNaming = 0.2;
      if (std::abs(v(c, k)) >= kWorthNaming) weak.parts.emplace_back(in.names[as_size(c)], v(c, k));
    }
    std::stable_sort(weak.parts.begin(), weak.parts.end(),
                     [](const auto& a, const auto& b) { return std::abs(a.second) > std::abs(b.second); });
    out.weak.push_back(std::move(weak));
  }
  return out;
}

std::string described(const WeakCombination& weak) {
  std::string names, shares;
  for (const auto& [name, share] : weak.parts) {
    names += (names.empty() ? "" : " with ") + name;
    shares += (shares.empty() ? "" : ", ") + short_number(std::round(100.0 * share) / 100.0);
  }
  return names + " (" + shares + ")";
}

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
