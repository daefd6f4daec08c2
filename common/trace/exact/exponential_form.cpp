#include "common/trace/exact/exponential_form.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <type_traits>

#include "common/base/index.h"

namespace palpate {
namespace {

constexpr std::size_t kTerms = 24;

/// 1 / k.
constexpr auto kInverse = [] {
  std::array<double, kTerms + 4> inverse{};
  for (std::size_t k = 1; k < inverse.size(); ++k) inverse[k] = 1.0 / static_cast<double>(k);
  return inverse;
}();

}  // namespace

template <class Number>
Number DividedDifferences::node(int k) const {
  if constexpr (std::is_same_v<Number, double>) {
    return nodes_.nu[as_size(k)].real();
  } else {
    return nodes_.nu[as_size(k)];
  }
}

template <class Number>
Number DividedDifferences::get(unsigned set) {
  if ((known_ & (1u << set)) == 0u) {
    values_[set] = compute<Number>(set);
    known_ |= 1u << set;
  }
  if constexpr (std::is_same_v<Number, double>) {
    return values_[set].real();
  } else {
    return values_[set];
  }
}

template <class Number>
Number DividedDifferences::compute(unsigned set) {
  std::array<int, 4> index{};
  int count = 0;
  for (int k = 0; k < 4; ++k) {
    if ((set & (1u << k)) != 0u) index[as_size(count++)] = k;
  }
  if (count == 1) return std::exp(node<Number>(index[0]) * t_);

  // The recurrence over the two nodes farthest apart, unless all are so close that it would cancel.
  int p = index[0], q = index[1];
  double farthest = -1;
  for (int i = 0; i < count; ++i) {
    for (int j = i + 1; j < count; ++j) {
      const int a = index[as_size(i)], b = index[as_size(j)];
      const double distance = std::abs(node<Number>(a) - node<Number>(b));
      if (distance > farthest) {
        farthest = distance;
        p = a;
        q = b;
      }
    }
  }
  if (farthest * t_ > 1) {
    return (get<Number>(set & ~(1u << p)) - get<Number>(set & ~(1u << q))) /
           (node<Number>(q) - node<Number>(p));
  }
  return series<Number>(index, count);
}

/// exp(m t) t^n sum_k h_k((nu - m) t) / (k + n)!, n = count - 1, with the complete homogeneous symmetric
/// polynomials h_k and the mean m.
template <class Number>
Number DividedDifferences::series(const std::array<int, 4>& index, int count) const {
  constexpr double kNegligible = std::numeric_limits<double>::epsilon() / 16;
  Number mean{};
  for (int i = 0; i < count; ++i) mean += node<Number>(index[as_size(i)]);
  mean /= static_cast<double>(count);
  std::array<Number, 4> shift{}, h{};
  double widest = 0;
  for (std::size_t i = 0; i < as_size(count); ++i) {
    shift[i] = (node<Number>(index[i]) - mean) * t_;
    h[i] = Number(1);
    widest = std::max(widest, std::abs(shift[i]));
  }
  double factor = 1;  // t^n / (k + n)!
  for (int i = 1; i < count; ++i) factor *= t_ * kInverse[as_size(i)];
  Number sum = Number(factor);
  // |h_k| <= (k + n)! / (k! n!) widest^k, so the k-th term is at most widest^k / k! of the first; widest is
  // at most 1. A vanishing term ends nothing, since h_k of symmetric nodes is zero for every other k, or two
  // in three.
  double bound = 1;
  for (std::size_t k = 1; k < kTerms; ++k) {
    bound *= widest * kInverse[k];
    if (bound < kNegligible) break;
    factor *= kInverse[k + as_size(count) - 1];
    Number below{};
    for (int i = 0; i < count; ++i) {
      const auto at = as_size(i);
      h[at] = below + shift[at] * h[at];
      below = h[at];
    }
    sum += below * factor;
  }
  return std::exp(mean * t_) * sum;
}

void ExponentialForm::add(unsigned set, const std::array<Complex, 4>& c) {
  for (std::size_t i = 0; i < 4; ++i) coefficient_[set][i] += c[i];
  used_ |= 1u << set;
}

ExponentialForm ExponentialForm::annihilated(const Nodes& nodes, int node) const {
  ExponentialForm out;
  const unsigned bit = 1u << node;
  for (unsigned set = 1u; set < 16u; ++set) {
    if ((used_ & (1u << set)) == 0u) continue;
    const std::array<Complex, 4>& c = coefficient_[set];
    if ((set & bit) != 0u) {
      if (set != bit) out.add(set & ~bit, c);
      continue;
    }
    const int s = std::countr_zero(set);
    const Complex gap = nodes.nu[as_size(s)] - nodes.nu[as_size(node)];
    out.add(set, {gap * c[0], gap * c[1], gap * c[2], gap * c[3]});
    const unsigned rest = set & ~(1u << s);
    if (rest != 0u) out.add(rest, c);
  }
  return out;
}

ExponentialForm::Four ExponentialForm::value(const Nodes& nodes, double t) const {
  DividedDifferences e(nodes, t);
  Four sum{};
  for (unsigned set = 1u; set < 16u; ++set) {
    if ((used_ & (1u << set)) == 0u) continue;
    const std::array<Complex, 4>& c = coefficient_[set];
    if (nodes.complex) {
      const Complex factor = e.get<Complex>(set);
      for (std::size_t i = 0; i < 4; ++i) sum[i] += c[i].real() * factor.real() - c[i].imag() * factor.imag();
    } else {
      const double factor = e.get<double>(set);
      for (std::size_t i = 0; i < 4; ++i) sum[i] += c[i].real() * factor;
    }
  }
  return sum;
}

double ExponentialForm::value(const Nodes& nodes, double t, std::size_t face) const {
  DividedDifferences e(nodes, t);
  double sum = 0;
  for (unsigned set = 1u; set < 16u; ++set) {
    if ((used_ & (1u << set)) == 0u) continue;
    const Complex c = coefficient_[set][face];
    if (nodes.complex) {
      const Complex factor = e.get<Complex>(set);
      sum += c.real() * factor.real() - c.imag() * factor.imag();
    } else {
      sum += c.real() * e.get<double>(set);
    }
  }
  return sum;
}

double ExponentialForm::magnitude(const Nodes& nodes, double t) const {
  DividedDifferences e(nodes, t);
  std::array<double, 4> sum{};
  for (unsigned set = 1u; set < 16u; ++set) {
    if ((used_ & (1u << set)) == 0u) continue;
    const double factor = nodes.complex ? std::abs(e.get<Complex>(set)) : std::abs(e.get<double>(set));
    for (std::size_t i = 0; i < 4; ++i) sum[i] += std::abs(coefficient_[set][i]) * factor;
  }
  return std::max(std::max(sum[0], sum[1]), std::max(sum[2], sum[3]));
}

}  // namespace palpate
