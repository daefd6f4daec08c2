#include "common/trace/exact/affine_modes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

#include <Eigen/Eigenvalues>

#include "common/base/index.h"
#include "common/trace/exact/first_zero.h"

namespace palpate {
namespace {

template <class Real>
struct Reach;
template <>
struct Reach<long double> {
  // Rates slower than this part of the fastest are rounding of the eigenvalues: no time beyond its inverse.
  static constexpr long double kHorizon = 0x1p58L;
  // exp() of more than this is not taken: the largest exponent of a long double is 11356.
  static constexpr long double kMaxExponent = 8000;
};
template <>
struct Reach<double> {
  // Rounding by then: 2^-35 of the cell.
  static constexpr double kHorizon = 0x1p18;
  static constexpr double kMaxExponent = 500;  // of at most 709
};

}  // namespace

template <class R>
void AffineModes<R>::make_rates(const PackedVertex* vertices, const TetMesh::Tet& tet, double sign) {
  using Three = std::array<Real, 3>;
  std::array<Three, 4> x{}, v{};
  for (std::size_t j = 0; j < 4; ++j) {
    for (int a = 0; a < 3; ++a) {
      x[j][as_size(a)] = vertices[tet[j]].x[a];
      v[j][as_size(a)] = static_cast<Real>(sign) * vertices[tet[j]].v[a];
    }
  }
  const auto minus = [](const Three& a, const Three& c) {
    return Three{a[0] - c[0], a[1] - c[1], a[2] - c[2]};
  };
  const auto cross = [](const Three& a, const Three& c) {
    return Three{a[1] * c[2] - a[2] * c[1], a[2] * c[0] - a[0] * c[2], a[0] * c[1] - a[1] * c[0]};
  };
  const auto dot = [](const Three& a, const Three& c) { return a[0] * c[0] + a[1] * c[1] + a[2] * c[2]; };
  const Three e0 = minus(x[0], x[3]), e1 = minus(x[1], x[3]), e2 = minus(x[2], x[3]);
  const std::array<Three, 3> normal{cross(e1, e2), cross(e2, e0), cross(e0, e1)};
  const Real det = dot(e0, normal[0]);
  rate_ = 0;
  for (std::size_t j = 0; j < 4; ++j) {
    matrix_[3][j] = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      matrix_[i][j] = dot(normal[i], v[j]) / det;
      matrix_[3][j] -= matrix_[i][j];
    }
    for (std::size_t i = 0; i < 4; ++i) rate_ = std::max(rate_, std::abs(matrix_[i][j]));
  }
}

template <class R>
void AffineModes<R>::make_schur() {
  using Matrix = Eigen::Matrix<Real, 3, 3>;
  Matrix c;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      const auto row = as_size(i);
      c(i, j) = (matrix_[row][as_size(j)] - matrix_[row][3]) / rate_;
    }
  }
  const Eigen::RealSchur<Matrix> schur(c);
  Eigen::Matrix<Complex, 3, 3> q = schur.matrixU().template cast<Complex>(),
                               t = schur.matrixT().template cast<Complex>();

  // A block of two rows that is left (a complex pair) is made triangular by a unitary turn. The pair stays
  // exactly conjugate and the third eigenvalue exactly real, which the search for zeros rests on.
  const int first = schur.matrixT()(1, 0) != 0 ? 0 : 1;
  const Real a = schur.matrixT()(first, first), b = schur.matrixT()(first, first + 1);
  const Real d = schur.matrixT()(first + 1, first), e = schur.matrixT()(first + 1, first + 1);
  const Real square = Real(0.25) * (a - e) * (a - e) + b * d;
  nodes_.complex = d != 0 && square < 0;
  if (d != 0) {
    const Complex half = nodes_.complex ? Complex(0, std::sqrt(-square)) : Complex(std::sqrt(square), 0);
    const Complex lambda = Real(0.5) * (a + e) + half, other = Real(0.5) * (a + e) - half;
    const Complex x0 = b, x1 = lambda - a;
    const Real size = std::sqrt(std::norm(x0) + std::norm(x1));
    Eigen::Matrix<Complex, 3, 3> turn = Eigen::Matrix<Complex, 3, 3>::Identity();
    turn(first, first) = x0 / size;
    turn(first + 1, first) = x1 / size;
    turn(first, first + 1) = -std::conj(x1) / size;
    turn(first + 1, first + 1) = std::conj(x0) / size;
    t = (turn.adjoint() * t * turn).eval();
    q = (q * turn).eval();
    t(first, first) = lambda;
    t(first + 1, first + 1) = other;
  }
  for (int i = 0; i < 3; ++i) {
    const auto row = as_size(i);
    for (int j = 0; j < 3; ++j) {
      q_[row][as_size(j)] = q(i, j);
      t_[row][as_size(j)] = t(i, j) * rate_;
    }
    nodes_.nu[row + 1] = t_[row][row];
  }
  annihilated_ = nodes_.complex && first == 0 ? 3 : 1;
}

template <class R>
typename AffineModes<R>::Four AffineModes<R>::rates_of(const Four& z) const {
  Four y{};
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = 0; j < 4; ++j) y[i] += matrix_[i][j] * z[j];
  }
  return y;
}

/// exp(tT) is upper triangular with t_ij E[i, j] + sum_k t_ik t_kj E[i, k, j] above its diagonal (Parlett's
/// recurrence written out); node k + 1 is the k-th of T.
template <class R>
typename AffineModes<R>::Form AffineModes<R>::make_rate_form(const Four& w) const {
  std::array<Complex, 3> y{};
  for (std::size_t j = 0; j < 3; ++j) {
    for (std::size_t i = 0; i < 3; ++i) y[j] += std::conj(q_[i][j]) * w[i];
  }
  Form form;
  const auto add = [&](unsigned set, std::size_t row, const Complex& factor) {
    std::array<Complex, 4> c{};
    for (std::size_t i = 0; i < 3; ++i) {
      c[i] = q_[i][row] * factor;
      c[3] -= c[i];
    }
    form.add(set, c);
  };
  for (std::size_t i = 0; i < 3; ++i) {
    add(2u << i, i, y[i]);
    for (std::size_t j = i + 1; j < 3; ++j) add((2u << i) | (2u << j), i, t_[i][j] * y[j]);
  }
  add(0b1110u, 0, t_[0][1] * t_[1][2] * y[2]);
  return form;
}

template <class R>
typename AffineModes<R>::Four AffineModes<R>::at(Real t) const {
  return position_.value(nodes_, t);
}

template <class R>
typename AffineModes<R>::Four AffineModes<R>::rate_at(Real t) const {
  return rate_form_.value(nodes_, t);
}

template <class R>
typename AffineModes<R>::Four AffineModes<R>::carried(const Four& d, Real t) const {
  if (!(rate_ > 0)) return d;
  return make_rate_form(d).value(nodes_, t);
}

template <class R>
AffineModes<R>::AffineModes(const PackedVertex* vertices, const TetMesh::Tet& tet, double sign, const Four& b,
                            int ignore) {
  make_rates(vertices, tet, sign);
  position_.add(1u, {b[0], b[1], b[2], b[3]});  // E[0] = 1
  if (!(rate_ > 0)) {
    rest_ = b;
    return;
  }
  make_schur();
  const Four slope = rates_of(b), curvature = rates_of(slope);
  rate_form_ = make_rate_form(slope);
  const Form& rate = rate_form_;
  // Integration from 0 puts the node 0 into every set.
  for (unsigned set = 2u; set < 16u; set += 2u) position_.add(set | 1u, rate[set]);
  const Form last = rate.annihilated(nodes_, annihilated_);

  Real horizon = Reach<R>::kHorizon / rate_;
  Real growth = 0;
  for (const Complex& nu : nodes_.nu) growth = std::max(growth, nu.real());
  if (growth > 0) horizon = std::min(horizon, Reach<R>::kMaxExponent / growth);

  Real until = horizon;
  for (int face = 0; face < 4 && until > 0; ++face) {
    if (face == ignore) continue;
    const auto i = as_size(face);
    const FirstZero<R> search(nodes_, position_, rate, last, annihilated_, face);
    Real from = 0;
    if (!(b[i] > 0)) {
      // On the face: a slope within rounding of zero is none, and the curvature tells whether the line comes
      // back inside; where that is none either, it runs along the face and does not leave by it.
      Real slope_scale = 0, curvature_scale = 0;
      for (std::size_t j = 0; j < 4; ++j) {
        slope_scale += std::abs(matrix_[i][j] * b[j]);
        curvature_scale += std::abs(matrix_[i][j] * slope[j]);
      }
      constexpr Real kGrazing = Real(1e-12);
      if (std::abs(slope[i]) <= kGrazing * slope_scale) {
        if (std::abs(curvature[i]) <= kGrazing * curvature_scale) continue;
        if (curvature[i] > 0) {
          // Looked for from where the line has come inside by more than rounding of slope and place.
          constexpr Real kRounding = 8 * std::numeric_limits<Real>::epsilon();
          from = std::max(4 * std::abs(slope[i]) / curvature[i], std::sqrt(kRounding / curvature[i]));
          if (!(search.value(from) > 0)) from = 0;
        }
      }
    }
    if (from >= until) continue;
    if (const std::optional<Real> zero = search.find(from, until)) {
      if (exit_.face < 0 || *zero < exit_.time) exit_ = {face, *zero};
      until = exit_.time;
    }
  }
  find_rest(slope, horizon);
  if constexpr (std::is_same_v<R, double>) {
    // Products of four rates, or times, have to stay within the numbers.
    const bool moderate = rate_ > 0x1p-200 && rate_ < 0x1p200;
    certain_ = moderate && (exit_.face >= 0 || rest_.has_value());
  }
}

/// A line that creeps towards a point (or a face) at rest may cross it later by rounding alone, or drift away
/// from it: where the rate has died out before the exit, the line rests there and does not leave.
template <class R>
void AffineModes<R>::find_rest(const Four& slope, Real horizon) {
  constexpr Real kAtRest = Real(0x1p-45);
  constexpr Real kSoonest = 16;  // no rate dies out sooner than this many times its inverse
  const auto largest = [](const Four& z) {
    return std::max(std::max(std::abs(z[0]), std::abs(z[1])), std::max(std::abs(z[2]), std::abs(z[3])));
  };
  const Real until = exit_.face >= 0 ? exit_.time : horizon, start = largest(slope);
  Real t = kSoonest / rate_;
  while (t < 2 * until) {
    const Real then = std::min(t, until);
    if (largest(rate_at(then)) <= kAtRest * start) {
      exit_ = Exit{};
      rest_ = at(then);
      return;
    }
    t *= 2;
  }
}

template class AffineModes<double>;
template class AffineModes<long double>;

}  // namespace palpate
