#include "common/trace/exact/first_zero.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "common/base/index.h"

namespace palpate {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
constexpr double kPi = std::numbers::pi;

/// Root of F in [a, b] with F(a) and F(b) of different sign: halving of the exponent while the bracket spans
/// several, then the Illinois rule.
template <class Function>
double bracketed(const Function& f, double a, double b, double fa, double fb) {
  constexpr double kSmallestPart = 0x1p-110;
  constexpr int kMaxEvaluations = 200;
  int kept = 0, slow = 0;
  double checkpoint = b - a;
  for (int n = 0; n < kMaxEvaluations && fb != 0; ++n) {
    if (b - a <= 2 * kEpsilon * b) break;
    double x;
    const bool wide = b > 16 * a;
    if (wide) {
      x = std::sqrt(std::max(a, kSmallestPart * b)) * std::sqrt(b);
      if (a < kSmallestPart * b && n > 12) break;
    } else {
      x = a + (b - a) * (fa / (fa - fb));
      if (++slow > 3) {
        if (b - a > 0.5 * checkpoint) x = 0.5 * (a + b);
        checkpoint = b - a;
        slow = 0;
      }
      const double margin = kEpsilon * b;
      x = std::clamp(x, a + margin, b - margin);
    }
    if (!(x > a && x < b)) break;
    const double fx = f(x);
    if (fx != 0 && std::signbit(fx) == std::signbit(fa)) {
      a = x;
      fa = fx;
      if (kept == 1 && !wide) fb *= 0.5;
      kept = 1;
    } else {
      b = x;
      fb = fx;
      if (kept == -1 && !wide) fa *= 0.5;
      kept = -1;
    }
  }
  return b;
}

/// Zeros of F on [knots.front(), knots.back()], F being monotone up to a positive factor between knots. A
/// zero at the first knot is not counted.
template <class Function, class Instants>
void zeros_between(const Function& f, const Instants& knots, double first_value, Instants& zeros) {
  double value = first_value;
  for (std::size_t k = 1; k < knots.size(); ++k) {
    const double next = f(knots[k]);
    if (value != 0 && next != 0 && std::signbit(value) != std::signbit(next)) {
      zeros.push_back(bracketed(f, knots[k - 1], knots[k], value, next));
    } else if (next == 0) {
      zeros.push_back(knots[k]);
    }
    value = next;
  }
}

/// E[a, b]. By the larger node: with the smaller one far below, its exponential sinks to zero while that of their
/// difference overflows.
double difference(double a, double b, double t) {
  const double x = std::abs(b - a) * t;
  constexpr double kSmall = 1e-12;
  return std::exp(std::max(a, b) * t) * t * (x > kSmall ? -std::expm1(-x) / x : 1 - 0.5 * x);
}

/// E[a, b, c], sorted.
double difference(const std::array<double, 3>& m, double t) {
  const double gap = m[2] - m[0];
  if (gap * t > 1) return (difference(m[1], m[2], t) - difference(m[0], m[1], t)) / gap;
  const double mean = (m[0] + m[1] + m[2]) / 3;
  const double a = (m[0] - mean) * t, b = (m[1] - mean) * t, d = (m[2] - mean) * t;
  double h0 = 1, h1 = 1, h2 = 1, factor = 0.5, sum = 0.5;
  for (int k = 1; k < 24; ++k) {
    h0 *= a;
    h1 = h0 + b * h1;
    h2 = h1 + d * h2;
    factor /= static_cast<double>(k + 2);
    sum += factor * h2;
  }
  return std::exp(mean * t) * t * t * sum;
}

/// Zero of first E[a] + second E[a, b], gap = b - a: t phi_1(gap t) = -first / second. Absent where none.
std::optional<double> zero_of_two(double first, double second, double gap) {
  const double r = -first / second;
  if (!(r > 0) || !std::isfinite(r)) return std::nullopt;
  if (gap == 0) return r;
  if (!(gap * r > -1)) return std::nullopt;
  return std::log1p(gap * r) / gap;
}

}  // namespace

FirstZero::FirstZero(const Nodes& nodes, const Form& position, const Form& rate, const Form& last,
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

FirstZero::Fall FirstZero::find(double until) const {
  return nodes_.complex ? find_complex(until) : find_real(until);
}

double FirstZero::fall_between(double from, double until) const {
  return fall_between(from, until, value(from), value(until));
}

double FirstZero::fall_between(double from, double until, double at_from, double at_until) const {
  const double level = at_from > 0.0 ? 0.0 : -kFaceRounding;
  const auto above = [&](double t) { return value(t) - level; };
  return bracketed(above, from, until, at_from - level, at_until - level);
}

/// Scans f, the zeros of the end of the chain being given.
std::optional<double> FirstZero::scan(double from, double until, const Instants& last_zeros) const {
  Instants knots;
  knots.push_back(from);
  for (const double t : last_zeros) {
    if (t > knots.back() && t < until) knots.push_back(t);
  }
  knots.push_back(until);
  const auto rate = [this](double t) { return rate_.value(nodes_, t, face_); };
  Instants turns;
  zeros_between(rate, knots, rate(from), turns);
  turns.push_back(until);
  double before = from, at_before = value(from);
  for (const double t : turns) {
    if (!(t > before)) continue;
    const double at_t = value(t);
    if (at_t < -kFaceRounding) return fall_between(before, t, at_before, at_t);
    before = t;
    at_before = at_t;
  }
  return std::nullopt;
}

/// More knots do no harm, and they are needed before a rate that decays has sunk to zero in the exponent of a
/// number: where each difference of two nodes has made one mode outweigh the other.
void FirstZero::add_outweighing(Instants& knots) const {
  constexpr double kOutweighed = 60;
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const double distance = std::abs(nodes_.nu[i].real() - nodes_.nu[j].real());
      if (distance > 0) knots.push_back(kOutweighed / distance);
    }
  }
}

FirstZero::Fall FirstZero::find_real(double until) const {
  // last = A E[a] + B E[b] + C E[a, b] = (A + B) E[a] + (C + B (b - a)) E[a, b].
  const auto a = as_size(others_[0]), b = as_size(others_[1]);
  const double gap = nodes_.nu[b].real() - nodes_.nu[a].real();
  const double ca = last_[1u << a][face_].real(), cb = last_[1u << b][face_].real();
  const double cab = last_[(1u << a) | (1u << b)][face_].real();
  Instants knots;
  if (const std::optional<double> zero = zero_of_two(ca + cb, cab + cb * gap, gap)) knots.push_back(*zero);
  add_outweighing(knots);
  std::sort(knots.begin(), knots.end());
  const std::optional<double> found = scan(0.0, until, knots);
  return {found.has_value(), found.value_or(until)};
}

FirstZero::Fall FirstZero::find_complex(double until) const {
  auto a = as_size(others_[0]), b = as_size(others_[1]);
  if (nodes_.nu[a].imag() < 0) std::swap(a, b);
  const Complex lambda = nodes_.nu[a];
  const double beta = lambda.imag(), gamma = nodes_.nu[as_size(annihilated_)].real();
  // last = A E[a] + B E[b] + C E[a, b] with b = conj(a): the real part of kappa exp(lambda t).
  const Complex c = last_[(1u << a) | (1u << b)][face_];
  const Complex kappa =
      last_[1u << a][face_] + std::conj(last_[1u << b][face_]) + c.real() / Complex(0, beta);
  const double phase = 0.5 * kPi - std::arg(kappa);

  // f = r + Re(K exp(lambda t)), r over the nodes 0 and gamma; r - |K| exp(alpha t) bounds it from below.
  const Complex amplitude = kappa / (lambda * (lambda - gamma));
  const Envelope envelope = make_envelope(amplitude, lambda, gamma);

  constexpr int kMaxRounds = 24;
  constexpr std::size_t kMaxKnots = 8;
  constexpr double kWindow = 4 * kPi;  // two turns
  double t = 0.0;
  for (int round = 0; round < kMaxRounds && t < until; ++round) {
    const double end = std::min(until, t + kWindow / beta);
    Instants knots;
    for (double k = std::ceil((beta * t - phase) / kPi); knots.size() < kMaxKnots; k += 1) {
      const double zero = (phase + k * kPi) / beta;
      if (!(zero < end)) break;
      knots.push_back(zero);
    }
    add_outweighing(knots);
    std::sort(knots.begin(), knots.end());
    if (const std::optional<double> found = scan(t, end, knots)) return {true, *found};
    t = end;
    if (!(t < until)) break;
    // Once the turns are less than rounding, f is r: monotone.
    constexpr double kGone = 0.125 * kFaceRounding;
    if (std::abs(amplitude) * std::exp(lambda.real() * t) <= kGone && lambda.real() <= 0) {
      const double at_until = value(until);
      if (at_until >= -kFaceRounding) return {false, until};
      return {true, fall_between(t, until, value(t), at_until)};
    }
    if (envelope.usable && envelope.value(t) > 0) {
      const double before = t;
      t = std::max(t, envelope.first_zero(t, until).value_or(until));
      // The envelope has digits enough for its value, not for the time at which a slow one comes to zero.
      if (const double at_t = value(t); at_t < -kFaceRounding)
        return {true, fall_between(before, t, value(before), at_t)};
    }
  }
  return {false, t};
}

double FirstZero::Envelope::value(double t) const {
  return c[0] * std::exp(m[0] * t) + c[1] * difference(m[0], m[1], t) + c[2] * difference(m, t);
}

/// First zero after `from`, where the envelope is positive.
std::optional<double> FirstZero::Envelope::first_zero(double from, double until) const {
  Instants knots;
  knots.push_back(from);
  const std::optional<double> turn = zero_of_two(c[1], c[2], m[2] - m[1]);
  if (turn && *turn > from && *turn < until) knots.push_back(*turn);
  knots.push_back(until);
  Instants zeros;
  const auto l = [this](double t) { return value(t); };
  zeros_between(l, knots, l(from), zeros);
  if (zeros.empty()) return std::nullopt;
  return zeros.front();
}

FirstZero::Envelope FirstZero::make_envelope(const Complex& amplitude, const Complex& lambda,
                                             double gamma) const {
  Envelope envelope;
  const double size = std::abs(amplitude), alpha = lambda.real();
  if (!std::isfinite(size)) return envelope;
  // Value, slope and curvature of l at 0, and from them Newton's form over the sorted nodes.
  const double r = value(0) - amplitude.real();
  const double slope = rate_.value(nodes_, 0, face_) - (amplitude * lambda).real();
  // What dips no deeper than rounding does not fall.
  const double l0 = r - size + 0.5 * kFaceRounding, l1 = slope - size * alpha,
               l2 = gamma * slope - size * alpha * alpha;
  envelope.m = {0, gamma, alpha};
  std::sort(envelope.m.begin(), envelope.m.end());
  const double m0 = envelope.m[0], m1 = envelope.m[1];
  envelope.c = {l0, l1 - m0 * l0, l2 - (m0 + m1) * l1 + m0 * m1 * l0};
  // Turns much larger than the cell leave it at once, and their difference from r would have no digits.
  constexpr double kLargest = 4.0;
  envelope.usable = size <= kLargest && std::isfinite(envelope.c[2]);
  return envelope;
}

}  // namespace palpate
