#include "common/trace/affine_modes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <Eigen/Eigenvalues>

namespace palpate {
namespace {

using Real = AffineModes::Real;
using Complex = AffineModes::Complex;
using Four = AffineModes::Four;

constexpr Real kEpsilon = std::numeric_limits<Real>::epsilon();
constexpr Real kPi = std::numbers::pi_v<Real>;
// Rates slower than this part of the fastest are rounding of the eigenvalues: no time beyond its inverse.
constexpr Real kHorizon = 0x1p58L;
// exp() of more than this is not taken: the largest exponent of a long double is 11356.
constexpr Real kMaxExponent = 8000.0L;

/// Root of F in [a, b] with F(a) and F(b) of different sign: halving of the exponent while the bracket spans
/// several, then the Illinois rule.
template <class Function>
Real bracketed(const Function& f, Real a, Real b, Real fa, Real fb) {
  constexpr Real kSmallestPart = 0x1p-110L;
  constexpr int kMaxEvaluations = 200;
  int kept = 0, slow = 0;
  Real checkpoint = b - a;
  for (int n = 0; n < kMaxEvaluations && fb != 0.0L; ++n) {
    if (b - a <= 2.0L * kEpsilon * b) break;
    Real x;
    const bool wide = b > 16.0L * a;
    if (wide) {
      x = std::sqrt(std::max(a, kSmallestPart * b)) * std::sqrt(b);
      if (a < kSmallestPart * b && n > 12) break;
    } else {
      x = a + (b - a) * (fa / (fa - fb));
      if (++slow > 3) {
        if (b - a > 0.5L * checkpoint) x = 0.5L * (a + b);
        checkpoint = b - a;
        slow = 0;
      }
      const Real margin = kEpsilon * b;
      x = std::clamp(x, a + margin, b - margin);
    }
    if (!(x > a && x < b)) break;
    const Real fx = f(x);
    if (fx != 0.0L && std::signbit(fx) == std::signbit(fa)) {
      a = x;
      fa = fx;
      if (kept == 1 && !wide) fb *= 0.5L;
      kept = 1;
    } else {
      b = x;
      fb = fx;
      if (kept == -1 && !wide) fa *= 0.5L;
      kept = -1;
    }
  }
  return b;
}

/// Zeros of F on [knots.front(), knots.back()], F being monotone up to a positive factor between knots. A
/// zero at the first knot is not counted; `falls_at_start` tells that F is negative right after it.
template <class Function>
void zeros_between(const Function& f, const std::vector<Real>& knots, Real first_value, bool only_first,
                   std::vector<Real>& zeros) {
  Real value = first_value;
  for (std::size_t k = 1; k < knots.size(); ++k) {
    const Real next = f(knots[k]);
    if (value != 0.0L && next != 0.0L && std::signbit(value) != std::signbit(next)) {
      zeros.push_back(bracketed(f, knots[k - 1], knots[k], value, next));
      if (only_first) return;
    } else if (next == 0.0L) {
      zeros.push_back(knots[k]);
      if (only_first) return;
    }
    value = next;
  }
}

}  // namespace

/// Divided differences of exp(nu t) over subsets of the nodes (bit k: node k), at one t.
class AffineModes::Differences {
 public:
  Differences(const AffineModes& modes, Real t) : modes_(modes), t_(t) {}

  template <class Number>
  Number get(unsigned mask) {
    if ((known_ & (1u << mask)) != 0u) return load<Number>(mask);
    const Number value = compute<Number>(mask);
    known_ |= 1u << mask;
    values_[mask] = value;
    return value;
  }

 private:
  template <class Number>
  Number load(unsigned mask) const {
    if constexpr (std::is_same_v<Number, Real>) {
      return values_[mask].real();
    } else {
      return values_[mask];
    }
  }
  template <class Number>
  Number node(int k) const {
    if constexpr (std::is_same_v<Number, Real>) {
      return modes_.nodes_[static_cast<std::size_t>(k)].real();
    } else {
      return modes_.nodes_[static_cast<std::size_t>(k)];
    }
  }

  template <class Number>
  Number compute(unsigned mask) {
    std::array<int, 4> index{};
    int count = 0;
    for (int k = 0; k < 4; ++k) {
      if ((mask & (1u << k)) != 0u) index[static_cast<std::size_t>(count++)] = k;
    }
    if (count == 1) return std::exp(node<Number>(index[0]) * t_);

    // The two nodes farthest apart.
    int p = index[0], q = index[1];
    Real farthest = -1.0L;
    for (int i = 0; i < count; ++i) {
      for (int j = i + 1; j < count; ++j) {
        const int a = index[static_cast<std::size_t>(i)], b = index[static_cast<std::size_t>(j)];
        const Real distance = std::abs(node<Number>(a) - node<Number>(b));
        if (distance > farthest) {
          farthest = distance;
          p = a;
          q = b;
        }
      }
    }
    if (farthest * t_ > 1.0L) {
      return (get<Number>(mask & ~(1u << p)) - get<Number>(mask & ~(1u << q))) /
             (node<Number>(q) - node<Number>(p));
    }
    return series<Number>(index, count);
  }

  /// exp(mt) t^n sum_k h_k((nu - m) t) / (k + n)!, n = count - 1, with the complete homogeneous symmetric
  /// polynomials h_k.
  template <class Number>
  Number series(const std::array<int, 4>& index, int count) const {
    Number mean{};
    for (int i = 0; i < count; ++i) mean += node<Number>(index[static_cast<std::size_t>(i)]);
    mean /= static_cast<Real>(count);
    std::array<Number, 4> shift{}, h{};
    for (int i = 0; i < count; ++i) {
      shift[static_cast<std::size_t>(i)] = (node<Number>(index[static_cast<std::size_t>(i)]) - mean) * t_;
      h[static_cast<std::size_t>(i)] = Number(1.0L);
    }
    Real factor = 1.0L;  // t^n / (k + n)!
    for (int i = 1; i < count; ++i) factor *= t_ / static_cast<Real>(i);
    Number sum = Number(factor);
    constexpr int kTerms = 30;
    for (int k = 1; k < kTerms; ++k) {
      factor /= static_cast<Real>(k + count - 1);
      Number below{};
      for (int i = 0; i < count; ++i) {
        const auto at = static_cast<std::size_t>(i);
        h[at] = below + shift[at] * h[at];
        below = h[at];
      }
      const Number term = below * factor;
      sum += term;
      if (std::abs(term) < 0.01L * kEpsilon * std::abs(sum) && k > 2) break;
    }
    return std::exp(mean * t_) * sum;
  }

  const AffineModes& modes_;
  Real t_;
  unsigned known_ = 0u;
  std::array<Complex, 16> values_{};
};

void AffineModes::make_rates(const PackedVertex* vertices, const TetMesh::Tet& tet, double sign) {
  using Three = std::array<Real, 3>;
  std::array<Three, 4> x{}, v{};
  for (std::size_t j = 0; j < 4; ++j) {
    for (int a = 0; a < 3; ++a) {
      x[j][static_cast<std::size_t>(a)] = vertices[tet[j]].x[a];
      v[j][static_cast<std::size_t>(a)] = static_cast<Real>(sign) * vertices[tet[j]].v[a];
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
  rate_ = 0.0L;
  for (std::size_t j = 0; j < 4; ++j) {
    matrix_[3][j] = 0.0L;
    for (std::size_t i = 0; i < 3; ++i) {
      matrix_[i][j] = dot(normal[i], v[j]) / det;
      matrix_[3][j] -= matrix_[i][j];
    }
    for (std::size_t i = 0; i < 4; ++i) rate_ = std::max(rate_, std::abs(matrix_[i][j]));
  }
}

void AffineModes::make_nodes() {
  Eigen::Matrix<Real, 3, 3> c;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      const auto row = static_cast<std::size_t>(i);
      c(i, j) = (matrix_[row][static_cast<std::size_t>(j)] - matrix_[row][3]) / rate_;
    }
  }
  const Eigen::RealSchur<Eigen::Matrix<Real, 3, 3>> schur(c, false);
  const auto& t = schur.matrixT();
  std::vector<Complex> lambda;
  for (int i = 0; i < 3; ++i) {
    if (i < 2 && t(i + 1, i) != 0.0L) {
      // A standardised or raw 2 x 2 block with a complex pair, or two real values.
      const Real half = 0.5L * (t(i, i) - t(i + 1, i + 1));
      const Real mean = 0.5L * (t(i, i) + t(i + 1, i + 1));
      const Real square = half * half + t(i, i + 1) * t(i + 1, i);
      if (square < 0.0L) {
        lambda.emplace_back(mean, std::sqrt(-square));
        lambda.emplace_back(mean, -std::sqrt(-square));
        complex_ = true;
      } else {
        lambda.emplace_back(mean + std::sqrt(square), 0.0L);
        lambda.emplace_back(mean - std::sqrt(square), 0.0L);
      }
      ++i;
    } else {
      lambda.emplace_back(t(i, i), 0.0L);
    }
  }
  lambda.emplace_back(0.0L, 0.0L);
  // Stable, with the imaginary part left out: a pair has equal real parts and stays side by side unless a
  // real node has exactly theirs, which the second key prevents.
  std::stable_sort(lambda.begin(), lambda.end(), [](const Complex& a, const Complex& b) {
    if (a.real() != b.real()) return a.real() < b.real();
    return (a.imag() != 0.0L) && (b.imag() == 0.0L);
  });
  for (std::size_t k = 0; k < 4; ++k) nodes_[k] = lambda[k] * rate_;
  for (int k = 0; k < 4 && complex_; ++k) {
    if (nodes_[static_cast<std::size_t>(k)].imag() != 0.0L) {
      pair_ = k;
      break;
    }
  }
}

Four AffineModes::times_minus(const Four& z, Real nu) const {
  Four y{};
  for (std::size_t i = 0; i < 4; ++i) {
    Real sum = -nu * z[i];
    for (std::size_t j = 0; j < 4; ++j) sum += matrix_[i][j] * z[j];
    y[i] = sum;
  }
  return y;
}

AffineModes::Form AffineModes::form_of(const Four& z, unsigned use) const {
  Form form;
  std::array<Complex, 4> y{z[0], z[1], z[2], z[3]};
  unsigned mask = 0u;
  for (int k = 0; k < 4; ++k) {
    if ((use & (1u << k)) == 0u) continue;
    mask |= 1u << k;
    const auto at = static_cast<std::size_t>(form.count);
    form.mask[at] = mask;
    form.coefficient[at] = y;
    ++form.count;
    std::array<Complex, 4> next{};
    for (std::size_t i = 0; i < 4; ++i) {
      Complex sum = -nodes_[static_cast<std::size_t>(k)] * y[i];
      for (std::size_t j = 0; j < 4; ++j) sum += matrix_[i][j] * y[j];
      next[i] = sum;
    }
    y = next;
  }
  return form;
}

Four AffineModes::value(const Form& form, Real t) const {
  Differences e(*this, t);
  Four sum{};
  for (int k = 0; k < form.count; ++k) {
    const auto at = static_cast<std::size_t>(k);
    if (complex_) {
      const Complex factor = e.get<Complex>(form.mask[at]);
      for (std::size_t i = 0; i < 4; ++i) sum[i] += (form.coefficient[at][i] * factor).real();
    } else {
      const Real factor = e.get<Real>(form.mask[at]);
      for (std::size_t i = 0; i < 4; ++i) sum[i] += form.coefficient[at][i].real() * factor;
    }
  }
  return sum;
}

AffineModes::Four AffineModes::at(Real t) const { return value(form_, t); }

AffineModes::Four AffineModes::carried(const Four& d, Real t) const { return value(form_of(d, 0b1111u), t); }

/// Finds the first zero of one barycentric coordinate.
class AffineModes::FaceSearch {
 public:
  FaceSearch(const AffineModes& modes, const Form& chain, int face)
      : modes_(modes), chain_(chain), face_(static_cast<std::size_t>(face)) {}

  [[nodiscard]] Real value(Real t) const { return one(modes_.form_, t); }

  /// The first zero in (from, until], where the coordinate is positive at `from` (or zero and about to
  /// change: a zero is then reported at `from` if it falls).
  [[nodiscard]] std::optional<Real> first(Real from, Real until) const {
    return modes_.complex_ ? first_complex(from, until) : first_real(from, until);
  }

 private:
  [[nodiscard]] Real one(const Form& form, Real t) const {
    Differences e(modes_, t);
    Real sum = 0.0L;
    for (int k = 0; k < form.count; ++k) {
      const auto at = static_cast<std::size_t>(k);
      sum += modes_.complex_ ? (form.coefficient[at][face_] * e.get<Complex>(form.mask[at])).real()
                             : form.coefficient[at][face_].real() * e.get<Real>(form.mask[at]);
    }
    return sum;
  }

  /// Scans f with the zeros of the end of the chain given.
  [[nodiscard]] std::optional<Real> scan(Real from, Real until, const std::vector<Real>& last_zeros) const {
    std::vector<Real> knots{from};
    for (const Real t : last_zeros) {
      if (t > from && t < until) knots.push_back(t);
    }
    knots.push_back(until);
    const auto middle = [this](Real t) { return one(chain_, t); };
    std::vector<Real> zeros;
    zeros_between(middle, knots, middle(from), false, zeros);
    std::vector<Real> outer{from};
    for (const Real t : zeros) {
      if (t > outer.back() && t < until) outer.push_back(t);
    }
    outer.push_back(until);
    const auto f = [this](Real t) { return value(t); };
    const Real start = f(from);
    if (start <= 0.0L) {
      // On the face (or outside by rounding): f is monotone up to the first knot, so its sign there tells.
      if (f(outer[1]) < 0.0L) return from;
    }
    std::vector<Real> found;
    zeros_between(f, outer, std::max(start, 0.0L), true, found);
    if (found.empty()) return std::nullopt;
    return found.front();
  }

  [[nodiscard]] std::optional<Real> first_real(Real from, Real until) const {
    // (D - nu_2)(D - nu_1) f = c_2 E[nu_3] + c_3 E[nu_3, nu_4] vanishes where t phi_1((nu_4 - nu_3) t) = r.
    const Real c2 = modes_.form_.coefficient[2][face_].real(), c3 = modes_.form_.coefficient[3][face_].real();
    std::vector<Real> last;
    const Real r = -c2 / c3;
    if (r > 0.0L && std::isfinite(r)) {
      const Real gap = modes_.nodes_[3].real() - modes_.nodes_[2].real();
      last.push_back(gap > 0.0L ? std::log1p(gap * r) / gap : r);
    }
    return scan(from, until, last);
  }

  [[nodiscard]] std::optional<Real> first_complex(Real from, Real until) const {
    const auto pair = static_cast<std::size_t>(modes_.pair_);
    const Complex lambda{modes_.nodes_[pair].real(), std::abs(modes_.nodes_[pair].imag())};
    const Real beta = lambda.imag();
    std::array<Real, 2> real_nodes{};
    int count = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      if (k != pair && k != pair + 1) real_nodes[static_cast<std::size_t>(count++)] = modes_.nodes_[k].real();
    }
    // End of the chain: (D - n_2)(D - n_1) f = exp(alpha t) (p cos(beta t) + q sin(beta t)).
    const Four start = real_start();
    const Four y1 = modes_.times_minus(start, real_nodes[0]);
    const Four y2 = modes_.times_minus(y1, real_nodes[1]);
    const Four y2_slope = modes_.times_minus(y2, 0.0L);
    const Real p = y2[face_];
    const Real q = (y2_slope[face_] - lambda.real() * p) / beta;
    const Real phase = std::atan2(q, p) + 0.5L * kPi;

    // f = r(t) + Re(K exp(lambda t)), r a sum over the real nodes; r - |K| exp(alpha t) bounds it below.
    const Complex amplitude = Complex(p, -q) / ((lambda - real_nodes[0]) * (lambda - real_nodes[1]));
    const Envelope envelope = make_envelope(start, amplitude, lambda, real_nodes);

    constexpr int kMaxRounds = 24;
    constexpr Real kWindow = 4.0L * kPi;  // two turns
    Real t = from;
    for (int round = 0; round < kMaxRounds && t < until; ++round) {
      const Real end = std::min(until, t + kWindow / beta);
      std::vector<Real> last;
      Real k = std::ceil((beta * t - phase) / kPi);
      for (Real zero = (phase + k * kPi) / beta; zero < end && last.size() < 8; ++k) {
        zero = (phase + k * kPi) / beta;
        last.push_back(zero);
      }
      if (const std::optional<Real> found = scan(t, end, last)) return found;
      t = end;
      if (t < until && envelope.usable && envelope.value(t) > 0.0L) {
        const std::optional<Real> crossing = envelope.first_zero(t, until);
        if (!crossing) return std::nullopt;
        t = std::max(t, *crossing);
      }
    }
    return std::nullopt;
  }

  /// sum_k c_k E[m_1 .. m_(k+1)] over three sorted real nodes.
  struct Envelope {
    bool usable = false;
    std::array<Real, 3> m{}, c{};

    [[nodiscard]] Real two(Real a, Real b, Real t) const {  // E[a, b]
      const Real x = (b - a) * t;
      const Real phi = std::abs(x) > 1e-12L ? std::expm1(x) / x : 1.0L + 0.5L * x;
      return std::exp(a * t) * t * phi;
    }
    [[nodiscard]] Real three(Real t) const {  // E[m_0, m_1, m_2]
      const Real gap = m[2] - m[0];
      if (gap * t > 1.0L) return (two(m[1], m[2], t) - two(m[0], m[1], t)) / gap;
      const Real mean = (m[0] + m[1] + m[2]) / 3.0L;
      const Real a = (m[0] - mean) * t, b = (m[1] - mean) * t, d = (m[2] - mean) * t;
      Real h0 = 1.0L, h1 = 1.0L, h2 = 1.0L, factor = 0.5L, sum = 0.5L;
      for (int k = 1; k < 24; ++k) {
        h0 *= a;
        h1 = h0 + b * h1;
        h2 = h1 + d * h2;
        factor /= static_cast<Real>(k + 2);
        sum += factor * h2;
      }
      return std::exp(mean * t) * t * t * sum;
    }
    [[nodiscard]] Real value(Real t) const {
      return c[0] * std::exp(m[0] * t) + c[1] * two(m[0], m[1], t) + c[2] * three(t);
    }
    /// First zero after `from`, where the envelope is positive.
    [[nodiscard]] std::optional<Real> first_zero(Real from, Real until) const {
      // (D - m_0) l = c_1 E[m_1] + c_2 E[m_1, m_2].
      std::vector<Real> knots{from};
      const Real r = -c[1] / c[2];
      if (r > 0.0L && std::isfinite(r)) {
        const Real gap = m[2] - m[1];
        const Real zero = gap > 0.0L ? std::log1p(gap * r) / gap : r;
        if (zero > from && zero < until) knots.push_back(zero);
      }
      knots.push_back(until);
      std::vector<Real> zeros;
      const auto l = [this](Real t) { return value(t); };
      zeros_between(l, knots, l(from), true, zeros);
      if (zeros.empty()) return std::nullopt;
      return zeros.front();
    }
  };

  [[nodiscard]] Envelope make_envelope(const Four& start, const Complex& amplitude, const Complex& lambda,
                                       const std::array<Real, 2>& n) const {
    Envelope envelope;
    const Real size = std::abs(amplitude);
    if (!std::isfinite(size)) return envelope;
    const Four slope = modes_.times_minus(start, 0.0L);
    const Real r0 = start[face_] - amplitude.real();
    const Real r0_slope = slope[face_] - (amplitude * lambda).real();
    const Real r1 = r0_slope - n[0] * r0;
    const Real alpha = lambda.real();
    // Values of l, l' and l'' at 0, and from them the coefficients of Newton's form over the sorted nodes.
    const Real l0 = r0 - size;
    const Real l1 = r0_slope - size * alpha;
    const Real l2 = n[0] * r0_slope + n[1] * r1 - size * alpha * alpha;
    envelope.m = {n[0], n[1], alpha};
    std::sort(envelope.m.begin(), envelope.m.end());
    const Real m0 = envelope.m[0], m1 = envelope.m[1];
    envelope.c = {l0, l1 - m0 * l0, l2 - (m0 + m1) * l1 + m0 * m1 * l0};
    envelope.usable = std::isfinite(envelope.c[2]);
    return envelope;
  }

  [[nodiscard]] Four real_start() const {
    Four b{};
    for (std::size_t i = 0; i < 4; ++i) b[i] = modes_.form_.coefficient[0][i].real();
    return b;
  }

  const AffineModes& modes_;
  const Form& chain_;
  std::size_t face_;
};

AffineModes::AffineModes(const PackedVertex* vertices, const TetMesh::Tet& tet, double sign, const Four& b,
                         int entry, int ignore) {
  make_rates(vertices, tet, sign);
  if (!(rate_ > 0.0L)) {
    form_.count = 1;
    form_.mask[0] = 1u;
    form_.coefficient[0] = {b[0], b[1], b[2], b[3]};
    rest_ = b;
    return;
  }
  make_nodes();
  form_ = form_of(b, 0b1111u);

  // The first link of the chain annihilates the most negative real node.
  int annihilated = 0;
  while (nodes_[static_cast<std::size_t>(annihilated)].imag() != 0.0L) ++annihilated;
  const Form chain = form_of(times_minus(b, nodes_[static_cast<std::size_t>(annihilated)].real()),
                             0b1111u & ~(1u << annihilated));

  Real horizon = kHorizon / rate_;
  const Real growth = nodes_[3].real();
  if (growth > 0.0L) horizon = std::min(horizon, kMaxExponent / growth);

  const Four slope = times_minus(b, 0.0L);
  const Four curvature = times_minus(slope, 0.0L);
  Real until = horizon;
  for (int face = 0; face < 4; ++face) {
    if (face == ignore) continue;
    const auto i = static_cast<std::size_t>(face);
    const FaceSearch search(*this, chain, face);
    Real from = 0.0L;
    if (face == entry && slope[i] <= 0.0L) {
      // The line grazes the face that it came in by: a slope within rounding of zero is none, and the
      // curvature tells whether the line comes back inside.
      Real scale = 0.0L;
      for (std::size_t j = 0; j < 4; ++j) scale += std::abs(matrix_[i][j] * b[j]);
      constexpr Real kGrazing = 1e-12L;
      if (slope[i] >= -kGrazing * scale && curvature[i] > 0.0L) {
        from = 4.0L * -slope[i] / curvature[i];
        if (!(search.value(from) > 0.0L)) from = 0.0L;
      }
    }
    if (from >= until) continue;
    if (const std::optional<Real> zero = search.first(from, until)) {
      if (exit_.face < 0 || *zero < exit_.time) {
        exit_ = {face, *zero};
        until = *zero;
        if (!(until > 0.0L)) break;
      }
    }
  }
  if (exit_.face < 0) find_rest(horizon);
}

void AffineModes::find_rest(Real horizon) {
  constexpr Real kAtRest = 1e-12L;
  const Four late = at(horizon), earlier = at(0.5L * horizon);
  Real moved = 0.0L;
  for (std::size_t i = 0; i < 4; ++i) moved = std::max(moved, std::abs(late[i] - earlier[i]));
  if (moved <= kAtRest) rest_ = late;
}

}  // namespace palpate
