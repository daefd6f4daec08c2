#include "common/field/cells/cell_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <Eigen/Eigenvalues>

namespace palpate {
namespace {

/// Centres that spread less than this part of the corners, squared, lie in a plane.
constexpr double kFlat = 0.02;
/// Centres nearer than this part of the cells, squared, weigh no more.
constexpr double kNear = 1e-6;

/// What is left of a pivot of a matrix by rounding, as a part of its diagonal.
constexpr double kRounding = 1e-13;

/// L with L L^T = a, or false.
bool cholesky(const Mat3& a, double least, Mat3& l) {
  l = Mat3(0.0);
  for (int j = 0; j < 3; ++j) {
    double pivot = a[j][j];
    for (int k = 0; k < j; ++k) pivot -= l[k][j] * l[k][j];
    if (!(pivot > std::max(least, kRounding * a[j][j]))) return false;
    l[j][j] = std::sqrt(pivot);
    for (int i = j + 1; i < 3; ++i) {
      double sum = a[j][i];
      for (int k = 0; k < j; ++k) sum -= l[k][i] * l[k][j];
      l[j][i] = sum / l[j][j];
    }
  }
  return true;
}

/// x with l x = b.
Vec3 solve_lower(const Mat3& l, const Vec3& b) {
  Vec3 x{0.0};
  for (int i = 0; i < 3; ++i) {
    double sum = b[i];
    for (int k = 0; k < i; ++k) sum -= l[k][i] * x[k];
    x[i] = sum / l[i][i];
  }
  return x;
}

/// x with l^T x = b.
Vec3 solve_upper(const Mat3& l, const Vec3& b) {
  Vec3 x{0.0};
  for (int i = 2; i >= 0; --i) {
    double sum = b[i];
    for (int k = i + 1; k < 3; ++k) sum -= l[i][k] * x[k];
    x[i] = sum / l[i][i];
  }
  return x;
}

/// Axes along which centres do not spread.
struct FlatAxes {
  std::array<Vec3, 3> axis{};
  std::size_t count = 0;
};

/// The inverse where the matrix has one, zero along the others of its axes.
Mat3 inverse_of(const Mat3& moments, FlatAxes& flat) {
  const double trace = moments[0][0] + moments[1][1] + moments[2][2];
  // The least eigenvalue is at least 4 det / trace^2.
  if (4.0 * glm::determinant(moments) > kFlat * trace * trace) return glm::inverse(moments);
  Eigen::Matrix3d m;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) m(i, j) = moments[j][i];
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(m);
  Mat3 out(0.0);
  for (int a = 0; a < 3; ++a) {
    const Vec3 axis{axes.eigenvectors()(0, a), axes.eigenvectors()(1, a), axes.eigenvectors()(2, a)};
    if (axes.eigenvalues()(a) > kFlat) {
      out += glm::outerProduct(axis, axis) / axes.eigenvalues()(a);
    } else {
      flat.axis[flat.count++] = axis;
    }
  }
  return out;
}

/// Takes gradients in units of the spread to those without a part across the layer in space, which is another
/// direction: the spread of tetrahedra leans along the diagonals by which cells were split.
Mat3 within_layer(const Mat3& units, const FlatAxes& flat) {
  Mat3 out(1.0);
  std::array<Vec3, 3> normals{};
  for (std::size_t a = 0; a < flat.count; ++a) {
    Vec3 normal = glm::normalize(solve_upper(units, flat.axis[a]));
    for (std::size_t b = 0; b < a; ++b) normal -= glm::dot(normal, normals[b]) * normals[b];
    normals[a] = glm::normalize(normal);
    // g_y = L^T g_x, so that what is taken away is L^T n (n . L^-T g_y).
    out -= glm::outerProduct(glm::transpose(units) * normals[a], solve_lower(units, normals[a]));
  }
  return out;
}

}  // namespace

void CellFit::set(std::span<const Vec3> centres, std::size_t near, const Mat3& spread) {
  near_ = near;
  flat_ = false;
  y_.assign(centres.begin(), centres.end());
  weight_.assign(centres.size(), 1.0);
  mean_ = Vec3{0.0};
  Mat3 units;
  if (!cholesky(spread, 0.0, units)) {
    flat_ = true;
    inverse_ = Mat3(0.0);
  } else {
    for (std::size_t i = 0; i < y_.size(); ++i) {
      y_[i] = solve_lower(units, y_[i]);
      weight_[i] = 1.0 / std::max(kNear, glm::dot(y_[i], y_[i]));
    }
  }
  double total = 0.0;
  for (const double w : weight_) total += w;
  for (double& w : weight_) w /= total;
  if (flat_) return;
  for (std::size_t i = 0; i < y_.size(); ++i) mean_ += weight_[i] * y_[i];
  Mat3 moments(0.0);
  for (std::size_t i = 0; i < y_.size(); ++i)
    moments += weight_[i] * glm::outerProduct(y_[i] - mean_, y_[i] - mean_);
  FlatAxes flat;
  inverse_ = inverse_of(moments, flat);
  flat_ = flat.count > 0;
  if (flat_) inverse_ = within_layer(units, flat) * inverse_;
}

double CellFit::value(std::span<const double> values, std::size_t stride) const {
  double mean = 0.0, lower = values[0], upper = values[0];
  for (std::size_t i = 0; i < y_.size(); ++i) mean += weight_[i] * values[i * stride];
  Vec3 change{0.0};
  for (std::size_t i = 0; i < y_.size(); ++i)
    change += weight_[i] * (values[i * stride] - mean) * (y_[i] - mean_);
  const Vec3 gradient = inverse_ * change;
  double least = std::numeric_limits<double>::infinity(), most = -least;
  for (std::size_t i = 0; i < near_; ++i) {
    const double way = -glm::dot(gradient, y_[i]);
    least = std::min(least, way);
    most = std::max(most, way);
    lower = std::min(lower, values[i * stride]);
    upper = std::max(upper, values[i * stride]);
  }
  const double value = mean - glm::dot(gradient, mean_);
  if (!std::isfinite(value)) return value;
  double below = std::min(0.0, most), above = std::max(0.0, least);
  if ((value < lower && below < 0.0) || (value > upper && above > 0.0)) {
    const double share = linear_share(values, stride, gradient);
    below *= share;
    above *= share;
  }
  return std::clamp(value, lower + below, upper + above);
}

double CellFit::linear_share(std::span<const double> values, std::size_t stride, const Vec3& gradient) const {
  constexpr double kNone = 0.02, kAll = 0.15;
  double least = values[0], most = values[0];
  for (std::size_t i = 0; i < y_.size(); ++i) {
    least = std::min(least, values[i * stride]);
    most = std::max(most, values[i * stride]);
  }
  double excess = 0.0;
  for (std::size_t k = 0; k < near_; ++k) {
    for (std::size_t i = 0; i < y_.size(); ++i) {
      const double there = values[k * stride] + glm::dot(gradient, y_[i] - y_[k]);
      excess = std::max(excess, std::max(there - most, least - there));
    }
  }
  if (!(excess > kNone * (most - least))) return 1.0;
  return std::max(0.0, (kAll - excess / (most - least)) / (kAll - kNone));
}

}  // namespace palpate
