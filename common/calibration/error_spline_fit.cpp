#include "common/calibration/error_spline_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "common/base/index.h"

namespace palpate {

using Eigen::Index;
using Eigen::MatrixXd;

Box box_of(const std::vector<Vec3>& places) {
  Box box;
  for (const Vec3& p : places) box.include(p);
  return box;
}

ErrorSpline fit_spline(const std::vector<Vec3>& all_places, const MatrixXd& all_errors) {
  // Solving takes N^3; beyond this, every k-th measurement carries the spline.
  constexpr std::size_t kMostCenters = 1500;
  const std::size_t stride = (all_places.size() + kMostCenters - 1) / kMostCenters;
  std::vector<Vec3> places;
  for (std::size_t i = 0; i < all_places.size(); i += stride) places.push_back(all_places[i]);
  const auto n = static_cast<Index>(places.size());
  MatrixXd b = MatrixXd::Zero(n + 4, 6);
  for (Index i = 0; i < n; ++i) b.row(i) = all_errors.row(i * static_cast<Index>(stride));
  const double size = box_of(places).diagonal();

  MatrixXd k = MatrixXd::Zero(n + 4, n + 4);
  for (Index i = 0; i < n; ++i) {
    const Vec3& p = places[as_size(i)];
    for (Index j = 0; j < i; ++j) k(i, j) = k(j, i) = glm::distance(p, places[as_size(j)]);
    const std::array<double, 4> plane{1.0, p.x, p.y, p.z};
    for (Index c = 0; c < 4; ++c) k(i, n + c) = k(n + c, i) = plane[as_size(c)];
  }
  std::optional<MatrixXd> best;
  double least = HUGE_VAL;
  // |p - p'| is negative on the weights that matter, so smoothing enters with a minus sign.
  for (const double smoothing : {1e-3, 1e-2, 1e-1, 1.0}) {
    MatrixXd smoothed = k;
    smoothed.diagonal().head(n).array() -= smoothing * size;
    const MatrixXd inverse = smoothed.partialPivLu().inverse();
    MatrixXd w = inverse * b;
    if (!w.allFinite()) continue;
    // Leaving measurement i out changes its prediction by w_i / (K^-1)_ii; position and orientation count
    // alike.
    double position = 0.0, orientation = 0.0;
    for (Index i = 0; i < n; ++i) {
      position += w.row(i).leftCols(3).squaredNorm() / std::pow(inverse(i, i), 2);
      orientation += w.row(i).rightCols(3).squaredNorm() / std::pow(inverse(i, i), 2);
    }
    const double score = position / std::max(b.leftCols(3).squaredNorm(), 1e-300) +
                         orientation / std::max(b.rightCols(3).squaredNorm(), 1e-300);
    if (score >= least) continue;
    least = score;
    best = std::move(w);
  }
  ErrorSpline out;
  if (!best) return out;
  out.centers = places;
  for (Index i = 0; i < n; ++i) out.weights.push_back(pose_error_of(best->row(i)));
  for (Index c = 0; c < 4; ++c) out.plane[as_size(c)] = pose_error_of(best->row(n + c));
  return out;
}

}  // namespace palpate
