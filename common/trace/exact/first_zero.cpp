#include "common/trace/exact/first_zero.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "common/base/index.h"

namespace palpate {
namespace {

template <class Real>
constexpr Real kEpsilon = std::numeric_limits<Real>::epsilon();
template <class Real>
constexpr Real kPi = std::numbers::pi_v<Real>;

/// Root of F in [a, b] with F(a) and F(b) of different sign: halving of the exponent while the bracket spans
/// several, then the Illinois rule.
template <class Function, class Real>
Real bracketed(const Function& f, Real a, Real b, Real fa, Real fb) {
  constexpr Real kSmallestPart = Real(0x1p-110);
  constexpr int kMaxEvaluations = 200;
  int kept = 0, slow = 0;
  Real checkpoint = b - a;
  for (int n = 0; n < kMaxEvaluations && fb != 0; ++n) {
    if (b - a <= 2 * kEpsilon<Real> * b) break;
    Real x;
    const bool wide = b > 16 * a;
    if (wide) {
      x = std::sqrt(std::max(a, kSmallestPart * b)) * std::sqrt(b);
      if (a < kSmallestPart * b && n > 12) break;
    } else {
      x = a + (b - a) * (fa / (fa - fb));
      if (++slow > 3) {
        if (b - a > Real(0.5) * checkpoint) x = Real(0.5) * (a + b);
        checkpoint = b - a;
        slow = 0;
      }
      const Real margin = kEpsilon<Real> * b;
      x = std::clamp(x, a + margin, b - margin);
    }
    if (!(x > a && x < b)) break;
    const Real fx = f(x);
    if (fx != 0 && std::signbit(fx) == std::signbit(fa)) {
      a = x;
      fa = fx;
      if (kept == 1 && !wide) fb *= Real(0.5);
      kept = 1;
    } else {
      b = x;
      fb = fx;
      if (kept == -1 && !wide) fa *= Real(0.5);
      kept = -1;
    }
  }
  return b;
}

/// Zeros of F on [knots.front(), knots.back()], F being monotone up to a positive factor between knots. A
/// zero at the first knot is not counted.
template <class Function, class Instants, class Real>
void zeros_between(const Function& f, const Instants& knots, Real first_value, bool only_first,
                   Instants& zeros) {
  Real value = first_value;
  for (std::size_t k = 1; k < knots.size(); ++k) {
    const Real next = f(knots[k]);
    if (value != 0 && next != 0 && std::signbit(value) != std::signbit(next)) {
      zeros.push_back(bracketed(f, knots[k - 1], knots[k], value, next));
      if (only_first) return;
    } else if (next == 0) {
      zeros.push_back(knots[k]);
      if (only_first) return;
    }
    value = next;
  }
}

/// E[a, b].
template <class Real>
Real difference(Real a, Real b, Real t) {
  const Real x = (b - a) * t;
  constexpr Real kSmall = Real(1e-12);
  return std::exp(a * t) * t * (std::abs(x) > kSmall ? std::expm1(x) / x : 1 + Real(0.5) * x);
}

/// E[a, b, c], sorted.
template <class Real>
Real difference(const std::array<Real, 3>& m, Real t) {
  const Real gap = m[2] - m[0];
  if (gap * t > 1) return (difference(m[1], m[2], t) - difference(m[0], m[1], t)) / gap;
  const Real mean = (m[0] + m[1] + m[2]) / 3;
  const Real a = (m[0] - mean) * t, b = (m[1] - mean) * t, d = (m[2] - mean) * t;
  Real h0 = 1, h1 = 1, h2 = 1, factor = Real(0.5), sum = Real(0.5);
  for (int k = 1; k < 24; ++k) {
    h0 *= a;
    h1 = h0 + b * h1;
    h2 = h1 + d * h2;
    factor /= static_cast<Real>(k + 2);
    sum += factor * h2;
  }
  return std::exp(mean * t) * t * t * sum;
}

/// Zero of first E[a] + second E[a, b], gap = b - a: t phi_1(gap t) = -first / second. Absent where none.
template <class Real>
std::optional<Real> zero_of_two(Real first, Real second, Real gap) {
  const Real r = -first / second;
  if (!(r > 0) || !std::isfinite(r)) return std::nullopt;
  if (gap == 0) return r;
  if (!(gap * r > -1)) return std::nullopt;
  return std::log1p(gap * r) / gap;
}

}  // namespace

template <class R>
FirstZero<R>::FirstZero(const Nodes& nodes, const Form& position, const Form& rate, const Form& last,
                        int annihilated, int face)
    : nodes_(nodes),
      position_(position),
      rate_(rate),
      last_(last),
      annihilated_(annihilated),
      face_(as_size(face)) {
  std::size_t count = 0;
  for (int k = 1; k < 4; ++k) {
    if (k != annihilated) others_[count++] = k;
  }
}

template <class R>
std::optional<R> FirstZero<R>::find(Real from, Real until) const {
  return nodes_.complex ? find_complex(from, until) : find_real(from, until);
}

/// Scans f, the zeros of the end of the chain being given.
template <class R>
std::optional<R> FirstZero<R>::scan(Real from, Real until, const Instants& last_zeros) const {
  Instants knots;
  knots.push_back(from);
  for (const Real t : last_zeros) {
    if (t > knots.back() && t < until) knots.push_back(t);
  }
  knots.push_back(until);
  const auto rate = [this](Real t) { return rate_.value(nodes_, t, face_); };
  Instants turns;
  zeros_between(rate, knots, rate(from), false, turns);
  Instants outer;
  outer.push_back(from);
  for (const Real t : turns) {
    if (t > outer.back() && t < until) outer.push_back(t);
  }
  outer.push_back(until);
  const auto f = [this](Real t) { return value(t); };
  const Real start = f(from);
  // On the face (or outside by rounding): f is monotone up to the first knot, so its sign there tells.
  if (start <= 0 && f(outer[1]) < 0) return from;
  Instants found;
  zeros_between(f, outer, std::max(start, Real(0)), true, found);
  if (found.empty()) return std::nullopt;
  return found.front();
}

/// More knots do no harm, and they are needed before a rate that decays has sunk to zero in the exponent of a
/// number: where each difference of two nodes has made one mode outweigh the other.
template <class R>
void FirstZero<R>::add_outweighing(Instants& knots) const {
  constexpr Real kOutweighed = 60;
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const Real distance = std::abs(nodes_.nu[i].real() - nodes_.nu[j].real());
      if (distance > 0) knots.push_back(kOutweighed / distance);
    }
  }
}

template <class R>
std::optional<R> FirstZero<R>::find_real(Real from, Real until) const {
  // last = A E[a] + B E[b] + C E[a, b] = (A + B) E[a] + (C + B (b - a)) E[a, b].
  const auto a = as_size(others_[0]), b = as_size(others_[1]);
  const Real gap = nodes_.nu[b].real() - nodes_.nu[a].real();
  const Real ca = last_[1u << a][face_].real(), cb = last_[1u << b][face_].real();
  const Real cab = last_[(1u << a) | (1u << b)][face_].real();
  Instants knots;
  if (const std::optional<Real> zero = zero_of_two(ca + cb, cab + cb * gap, gap)) knots.push_back(*zero);
  add_outweighing(knots);
  std::sort(knots.begin(), knots.end());
  return scan(from, until, knots);
}

template <class R>
std::optional<R> FirstZero<R>::find_complex(Real from, Real until) const {
  auto a = as_size(others_[0]), b = as_size(others_[1]);
  if (nodes_.nu[a].imag() < 0) std::swap(a, b);
  const Complex lambda = nodes_.nu[a];
  const Real beta = lambda.imag(), gamma = nodes_.nu[as_size(annihilated_)].real();
  // last = A E[a] + B E[b] + C E[a, b] with b = conj(a): the real part of kappa exp(lambda t).
  const Complex c = last_[(1u << a) | (1u << b)][face_];
  const Complex kappa =
      last_[1u << a][face_] + std::conj(last_[1u << b][face_]) + c.real() / Complex(0, beta);
  const Real phase = Real(0.5) * kPi<Real> - std::arg(kappa);

  // f = r + Re(K exp(lambda t)), r over the nodes 0 and gamma; r - |K| exp(alpha t) bounds it from below.
  const Envelope envelope = make_envelope(kappa / (lambda * (lambda - gamma)), lambda, gamma);

  constexpr int kMaxRounds = 24;
  constexpr std::size_t kMaxKnots = 8;
  constexpr Real kWindow = 4 * kPi<Real>;  // two turns
  Real t = from;
  for (int round = 0; round < kMaxRounds && t < until; ++round) {
    const Real end = std::min(until, t + kWindow / beta);
    Instants knots;
    for (Real k = std::ceil((beta * t - phase) / kPi<Real>); knots.size() < kMaxKnots; k += 1) {
      const Real zero = (phase + k * kPi<Real>) / beta;
      if (!(zero < end)) break;
      knots.push_back(zero);
    }
    add_outweighing(knots);
    std::sort(knots.begin(), knots.end());
    if (const std::optional<Real> found = scan(t, end, knots)) return found;
    t = end;
    if (t < until && envelope.usable && envelope.value(t) > 0) {
      const std::optional<Real> crossing = envelope.first_zero(t, until);
      if (!crossing) return std::nullopt;
      t = std::max(t, *crossing);
    }
  }
  return std::nullopt;
}

template <class R>
R FirstZero<R>::Envelope::value(Real t) const {
  return c[0] * std::exp(m[0] * t) + c[1] * difference(m[0], m[1], t) + c[2] * difference(m, t);
}

/// First zero after `from`, where the envelope is positive.
template <class R>
std::optional<R> FirstZero<R>::Envelope::first_zero(Real from, Real until) const {
  Instants knots;
  knots.push_back(from);
  const std::optional<Real> turn = zero_of_two(c[1], c[2], m[2] - m[1]);
  if (turn && *turn > from && *turn < until) knots.push_back(*turn);
  knots.push_back(until);
  Instants zeros;
  const auto l = [this](Real t) { return value(t); };
  zeros_between(l, knots, l(from), true, zeros);
  if (zeros.empty()) return std::nullopt;
  return zeros.front();
}

template <class R>
typename FirstZero<R>::Envelope FirstZero<R>::make_envelope(const Complex& amplitude, const Complex& lambda,
                                                            Real gamma) const {
  Envelope envelope;
  const Real size = std::abs(amplitude), alpha = lambda.real();
  if (!std::isfinite(size)) return envelope;
  // Value, slope and curvature of l at 0, and from them Newton's form over the sorted nodes.
  const Real r = value(0) - amplitude.real();
  const Real slope = rate_.value(nodes_, 0, face_) - (amplitude * lambda).real();
  const Real l0 = r - size, l1 = slope - size * alpha, l2 = gamma * slope - size * alpha * alpha;
  envelope.m = {0, gamma, alpha};
  std::sort(envelope.m.begin(), envelope.m.end());
  const Real m0 = envelope.m[0], m1 = envelope.m[1];
  envelope.c = {l0, l1 - m0 * l0, l2 - (m0 + m1) * l1 + m0 * m1 * l0};
  envelope.usable = std::isfinite(envelope.c[2]);
  return envelope;
}

template class FirstZero<double>;
template class FirstZero<long double>;

}  // namespace palpate
