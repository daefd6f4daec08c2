/// The first root of a polynomial of low degree on [0, 1], for certain.
#pragma once

#include <array>
#include <cstddef>

namespace palpate {

/// Smallest theta in (0, 1] at which sum_j a_j theta^j, positive near 0, falls to zero; above 1 where it does
/// not. Bernstein coefficients bound the polynomial: an interval without a negative one holds no root; others
/// are halved (de Casteljau), the left half first. Dips below zero shorter than `resolution` may be passed.
template <std::size_t kDegree>
[[nodiscard]] double first_fall(const std::array<double, kDegree + 1>& a, double resolution) {
  constexpr std::size_t n = kDegree + 1;
  using Coefficients = std::array<double, n>;
  // b_i = sum_j C(i,j) / C(kDegree,j) a_j.
  Coefficients b{};
  for (std::size_t i = 0; i < n; ++i) {
    double weight = 1.0;
    for (std::size_t j = 0; j <= i; ++j) {
      b[i] += weight * a[j];
      if (j < kDegree) weight *= static_cast<double>(i - j) / static_cast<double>(kDegree - j);
    }
  }
  struct Part {
    Coefficients b;
    double low, high;
  };
  constexpr std::size_t kMaxParts = 64;
  std::array<Part, kMaxParts> stack;
  std::size_t size = 0;
  stack[size++] = {b, 0.0, 1.0};
  while (size > 0) {
    const Part part = stack[--size];
    bool negative = false;
    for (const double value : part.b) negative = negative || value < 0.0;
    if (!negative) continue;
    const double width = part.high - part.low;
    if (part.b[0] < 0.0) return part.low;
    if (width <= resolution || size + 2 > kMaxParts) {
      if (part.b[n - 1] < 0.0) return part.high;
      continue;
    }
    Part left{part.b, part.low, part.low + 0.5 * width}, right{part.b, part.low + 0.5 * width, part.high};
    Coefficients work = part.b;
    left.b[0] = work[0];
    right.b[n - 1] = work[n - 1];
    for (std::size_t level = 1; level < n; ++level) {
      for (std::size_t i = 0; i + level < n; ++i) work[i] = 0.5 * (work[i] + work[i + 1]);
      left.b[level] = work[0];
      right.b[n - 1 - level] = work[n - 1 - level];
    }
    stack[size++] = right;
    stack[size++] = left;
  }
  return 2.0;
}

}  // namespace palpate
