#include "common/math/symmetric3.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "common/base/index.h"
#include "common/math/power_of_two.h"

namespace palpate {
namespace {

/// Convergence is quadratic: four or five sweeps reach rounding; the bound is for NaN.
constexpr int kMostSweeps = 12;

struct Symmetric {
  std::array<std::array<double, 3>, 3> a;
  std::array<std::array<double, 3>, 3> v{{{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}}};  ///< rows

  /// Turns the plane (p, q) so that a[p][q] becomes zero.
  void rotate(std::size_t p, std::size_t q, bool with_vectors) noexcept {
    const double off = a[p][q];
    if (off == 0.0) return;
    // tan of the angle: the smaller root of t^2 + 2 theta t - 1 = 0.
    const double theta = (a[q][q] - a[p][p]) / (2.0 * off);
    // A theta whose square overflows turns by nothing, and rightly so: `off` is below rounding.
    const double t = std::copysign(1.0, theta) / (std::abs(theta) + std::sqrt(theta * theta + 1.0));
    const double c = 1.0 / std::sqrt(t * t + 1.0);
    const double s = t * c;
    a[p][p] -= t * off;
    a[q][q] += t * off;
    a[p][q] = a[q][p] = 0.0;
    const std::size_t r = 3 - p - q;
    const double rp = a[r][p];
    const double rq = a[r][q];
    a[r][p] = a[p][r] = c * rp - s * rq;
    a[r][q] = a[q][r] = s * rp + c * rq;
    if (!with_vectors) return;
    for (std::size_t i = 0; i < 3; ++i) {
      const double vp = v[p][i];
      const double vq = v[q][i];
      v[p][i] = c * vp - s * vq;
      v[q][i] = s * vp + c * vq;
    }
  }
};

SymmetricEigen solve(const Mat3& m, bool with_vectors) noexcept {
  double largest = 0.0;
  for (int c = 0; c < 3; ++c) {
    for (int r = c; r < 3; ++r) largest = std::max(largest, std::abs(m[c][r]));
  }
  const int exponent = binary_exponent(largest);
  // Two steps, since 2^-exponent alone may leave the range of a double.
  const double half = power_of_two(-exponent / 2);
  const double rest = power_of_two(-exponent - (-exponent / 2));
  Symmetric s{};
  for (int c = 0; c < 3; ++c) {
    for (int r = c; r < 3; ++r) {
      const double value = m[c][r] * half * rest;
      s.a[as_size(r)][as_size(c)] = value;
      s.a[as_size(c)][as_size(r)] = value;
    }
  }
  for (int sweep = 0; sweep < kMostSweeps; ++sweep) {
    // Off-diagonal parts below this no longer change the diagonal.
    constexpr double kDone = 0x1p-110;
    const double off = s.a[0][1] * s.a[0][1] + s.a[0][2] * s.a[0][2] + s.a[1][2] * s.a[1][2];
    if (off <= kDone) break;
    s.rotate(0, 1, with_vectors);
    s.rotate(0, 2, with_vectors);
    s.rotate(1, 2, with_vectors);
  }

  std::array<std::size_t, 3> order{0, 1, 2};
  std::sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) { return s.a[i][i] > s.a[j][j]; });
  SymmetricEigen out;
  for (int i = 0; i < 3; ++i) {
    const std::size_t from = order[as_size(i)];
    out.values[i] = s.a[from][from] / rest / half;
    out.vectors[i] = {s.v[from][0], s.v[from][1], s.v[from][2]};
  }
  if (with_vectors && glm::dot(glm::cross(out.vectors[0], out.vectors[1]), out.vectors[2]) < 0.0) {
    out.vectors[2] = -out.vectors[2];
  }
  return out;
}

bool lower_is_nan(const Mat3& m) noexcept {
  return std::isnan(m[0][0] + m[0][1] + m[0][2] + m[1][1] + m[1][2] + m[2][2]);
}

}  // namespace

SymmetricEigen symmetric_eigen(const Mat3& a) noexcept {
  if (!lower_is_nan(a)) return solve(a, true);
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  return {Vec3{kNaN}, Mat3{Vec3{kNaN}, Vec3{kNaN}, Vec3{kNaN}}};
}

Vec3 symmetric_eigenvalues(const Mat3& a) noexcept {
  return lower_is_nan(a) ? Vec3{std::numeric_limits<double>::quiet_NaN()} : solve(a, false).values;
}

}  // namespace palpate
