#include "common/calibration/identifiability.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Dense>

#include "common/base/check.h"
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

}  // namespace palpate
