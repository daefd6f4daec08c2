#include "common/trace/exact/affine_modes.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/base/index.h"
#include "common/math/double_double.h"
#include "common/trace/exact/first_zero.h"
#include "common/trace/exact/graded_schur.h"

template <>
class std::numeric_limits<palpate::DoubleDouble> : public std::numeric_limits<double> {
 public:
  static constexpr palpate::DoubleDouble epsilon() noexcept { return 0x1p-102; }
};

template <>
struct Eigen::NumTraits<palpate::DoubleDouble> : Eigen::GenericNumTraits<palpate::DoubleDouble> {
  using Real = palpate::DoubleDouble;
  using NonInteger = Real;
  using Nested = Real;
  enum {
    IsComplex = 0,
    IsInteger = 0,
    IsSigned = 1,
    RequireInitialization = 0,
    ReadCost = 2,
    AddCost = 20,
    MulCost = 25
  };
};

namespace palpate {
namespace {

using Complex = std::complex<double>;
using Four = AffineModes::Four;

// Beyond this no digit of a slow rate is left even in numbers of twice the digits (scaled time).
constexpr double kLongReach = 0x1p56;
// exp() of more than this is not taken, so that products of three stay within the numbers.
constexpr double kMaxExponent = 200.0;

double largest(const Four& z) {
  return std::max(std::max(std::abs(z[0]), std::abs(z[1])), std::max(std::abs(z[2]), std::abs(z[3])));
}

Four scaled(double factor, const Four& z) {
  return {factor * z[0], factor * z[1], factor * z[2], factor * z[3]};
}

/// B of exact_cell.h, rows first.
template <class Real>
std::array<std::array<Real, 4>, 4> rates_of_cell(const PackedVertex* vertices, const TetMesh::Tet& tet,
                                                 double sign) {
  using Three = std::array<Real, 3>;
  std::array<Three, 4> x{}, v{};
  for (std::size_t j = 0; j < 4; ++j) {
    for (int a = 0; a < 3; ++a) {
      x[j][as_size(a)] = vertices[tet[j]].x[a];
      v[j][as_size(a)] = sign * vertices[tet[j]].v[a];
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
  std::array<std::array<Real, 4>, 4> matrix{};
  for (std::size_t j = 0; j < 4; ++j) {
    for (std::size_t i = 0; i < 3; ++i) {
      matrix[i][j] = dot(normal[i], v[j]) / det;
      matrix[3][j] -= matrix[i][j];
    }
  }
  return matrix;
}

}  // namespace

template <class Real>
void AffineModes::make_modes(const PackedVertex* vertices, const TetMesh::Tet& tet, double sign,
                             const Four& b) {
  const auto matrix = rates_of_cell<Real>(vertices, tet, sign);
  rate_ = 0.0;
  for (const auto& row : matrix) {
    for (const Real& value : row) rate_ = std::max(rate_, std::abs(static_cast<double>(value)));
  }
  if (!(rate_ > 0.0)) return;
  using Matrix = Eigen::Matrix<Real, 3, 3>;
  Matrix c;
  std::array<Real, 3> w{};
  for (int i = 0; i < 3; ++i) {
    const auto& row = matrix[as_size(i)];
    for (int j = 0; j < 3; ++j) c(i, j) = (row[as_size(j)] - row[3]) / Real(rate_);
    for (std::size_t j = 0; j < 4; ++j) w[as_size(i)] += row[j] * Real(b[j]);
    w[as_size(i)] /= Real(rate_);
  }
  const GradedSchur<Real> schur(c);
  Eigen::Matrix<Complex, 3, 3> q, t;
  Eigen::Matrix<Complex, 3, 1> y;
  for (int i = 0; i < 3; ++i) {
    Real sum = 0.0;
    for (int j = 0; j < 3; ++j) {
      q(i, j) = static_cast<double>(schur.u(i, j));
      t(i, j) = static_cast<double>(schur.t(i, j));
      sum += schur.u(j, i) * w[as_size(j)];
    }
    y(i) = static_cast<double>(sum);
  }

  // A block of two rows that is left (a complex pair) is made triangular by a unitary turn. The pair stays
  // exactly conjugate and the third eigenvalue exactly real, which the search for zeros rests on.
  const int first = t(1, 0) != 0.0 ? 0 : 1;
  const double a = t(first, first).real(), above = t(first, first + 1).real();
  const double below = t(first + 1, first).real(), e = t(first + 1, first + 1).real();
  const double square = 0.25 * (a - e) * (a - e) + above * below;
  nodes_.complex = below != 0.0 && square < 0.0;
  if (below != 0.0) {
    const Complex half = nodes_.complex ? Complex(0.0, std::sqrt(-square)) : Complex(std::sqrt(square), 0.0);
    const Complex lambda = 0.5 * (a + e) + half, other = 0.5 * (a + e) - half;
    // (above, lambda - a) and (lambda - e, below) are the same vector, unless one of them is rounding.
    const bool by_row = std::abs(above) >= std::abs(below);
    const Complex x0 = by_row ? above : 0.5 * (a - e) + half, x1 = by_row ? 0.5 * (e - a) + half : below;
    const double size = std::sqrt(std::norm(x0) + std::norm(x1));
    Eigen::Matrix<Complex, 3, 3> turn = Eigen::Matrix<Complex, 3, 3>::Identity();
    turn(first, first) = x0 / size;
    turn(first + 1, first) = x1 / size;
    turn(first, first + 1) = -std::conj(x1) / size;
    turn(first + 1, first + 1) = std::conj(x0) / size;
    t = (turn.adjoint() * t * turn).eval();
    q = (q * turn).eval();
    y = (turn.adjoint() * y).eval();
    t(first, first) = lambda;
    t(first + 1, first + 1) = other;
    t(first + 1, first) = 0.0;
  }
  for (int i = 0; i < 3; ++i) {
    const auto row = as_size(i);
    for (int j = 0; j < 3; ++j) {
      q_[row][as_size(j)] = q(i, j);
      t_[row][as_size(j)] = t(i, j);
    }
    y_[row] = y(i);
    nodes_.nu[row + 1] = t(i, i);
  }
  annihilated_ = nodes_.complex && first == 0 ? 3 : 1;
}

/// exp(tT) is upper triangular with t_ij E[i, j] + sum_k t_ik t_kj E[i, k, j] above its diagonal (Parlett's
/// recurrence written out); node k + 1 is the k-th of T.
ExponentialForm AffineModes::make_rate_form(const std::array<Complex, 3>& y) const {
  ExponentialForm form;
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

Four AffineModes::at(double t) const { return position_.value(nodes_, rate_ * t); }

Four AffineModes::rate_at(double t) const { return scaled(rate_, rate_form_.value(nodes_, rate_ * t)); }

Four AffineModes::carried(const Four& d, double t) const {
  if (!(rate_ > 0.0)) return d;
  std::array<Complex, 3> y{};
  for (std::size_t j = 0; j < 3; ++j) {
    for (std::size_t i = 0; i < 3; ++i) y[j] += std::conj(q_[i][j]) * d[i];
  }
  return make_rate_form(y).value(nodes_, rate_ * t);
}

double AffineModes::rounding(double h, double t) const {
  constexpr double kOfDouble = 0x1p-52, kOfLong = 0x1p-100;
  return kOfDouble * std::max(1.0, position_.magnitude(nodes_, rate_ * t)) +
         (is_long_ ? kOfLong : kOfDouble) * rate_ * h;
}

AffineModes::AffineModes(const PackedVertex* vertices, const TetMesh::Tet& tet, double sign, const Four& b) {
  const Vec3 corner{vertices[tet[3]].x[0], vertices[tet[3]].x[1], vertices[tet[3]].x[2]};
  for (std::size_t j = 0; j < 4; ++j) {
    const PackedVertex& at = vertices[tet[j]];
    if (j < 3) edge_[j] = Vec3{at.x[0], at.x[1], at.x[2]} - corner;
    resolution_ = std::max(resolution_, at.v[3]);
  }
  make_modes<double>(vertices, tet, sign, b);
  find_exit(b, 4.0 * kDoublesReach);
  // Beside a fast rate doubles do not know a slow one from rest.
  if (!(rate_ > 0.0) || (exit_.face >= 0 && rate_ * exit_.time <= kDoublesReach)) return;
  is_long_ = true;
  make_modes<DoubleDouble>(vertices, tet, sign, b);
  find_exit(b, kLongReach);
}

void AffineModes::find_exit(const Four& b, double horizon) {
  exit_ = {};
  rest_.reset();
  position_ = ExponentialForm();
  position_.add(1u, {b[0], b[1], b[2], b[3]});  // E[0] = 1
  if (!(rate_ > 0.0)) {
    rest_ = b;
    return;
  }
  rate_form_ = make_rate_form(y_);
  // Integration from 0 puts the node 0 into every set.
  for (unsigned set = 2u; set < 16u; set += 2u) position_.add(set | 1u, rate_form_[set]);
  const ExponentialForm last = rate_form_.annihilated(nodes_, annihilated_);

  double growth = 0.0;
  for (const Complex& nu : nodes_.nu) growth = std::max(growth, nu.real());
  if (growth > 0.0) horizon = std::min(horizon, kMaxExponent / growth);
  double known = horizon;
  exit_.time = horizon / rate_;
  for (int face = 0; face < 4; ++face) {
    const FirstZero search(nodes_, position_, rate_form_, last, annihilated_, face);
    const FirstZero::Fall fall = search.find(std::min(known, rate_ * exit_.time));
    if (fall.falls) {
      exit_ = {face, fall.time / rate_};
    } else {
      known = std::min(known, fall.time);
    }
  }
  if (rate_ * exit_.time > known) exit_ = {-1, known / rate_};
  constexpr int kMaxCorrections = 4;
  for (int n = 0; n < kMaxCorrections && leave_earlier(0.0, exit_.time); ++n) {
  }
  // On its way out from the beginning: what it would move by is rounding.
  if (exit_.face >= 0 && rate_ * exit_.time * largest(rate_form_.value(nodes_, 0.0)) <= 4.0 * kFaceRounding)
    exit_.time = 0.0;
  find_rest();
}

bool AffineModes::leave_earlier(double from, double to) {
  const Four b = at(to);
  int face = -1;
  double deepest = -2.0 * kFaceRounding;
  for (int i = 0; i < 4; ++i) {
    if (i != exit_.face && b[as_size(i)] < deepest) {
      deepest = b[as_size(i)];
      face = i;
    }
  }
  if (face < 0) return false;
  const FirstZero search(nodes_, position_, rate_form_, rate_form_, annihilated_, face);
  exit_ = {face, search.fall_between(rate_ * from, rate_ * to) / rate_};
  return true;
}

/// Where the flow has died out before the exit, the line rests there and does not leave.
void AffineModes::find_rest() {
  constexpr double kSoonest = 16.0;  // no rate dies out sooner
  const double until = rate_ * exit_.time;
  for (double t = kSoonest; t < 2.0 * until; t *= 2.0) {
    const double then = std::min(t, until);
    const Four w = rate_form_.value(nodes_, then);
    if (rate_ * glm::length(w[0] * edge_[0] + w[1] * edge_[1] + w[2] * edge_[2]) <= resolution_) {
      exit_ = {-1, then / rate_};
      rest_ = position_.value(nodes_, then);
      return;
    }
  }
}

}  // namespace palpate
