/// Weighted sums of tensors that lie side by side in memory, six numbers each.
///
/// The two ends of a cell's edge along x are twelve numbers in a row: three loads of four.
#pragma once

#include <array>
#include <cstddef>

#include "common/math/pack4.h"

namespace palpate {
inline namespace PALPATE_PACK {

/// Six numbers: the first four and the last two.
struct Six {
  Pack4 first;
  __m128d last;
};

[[gnu::always_inline]] inline Pack4 four(const double* at) { return Pack4::load(at); }

#ifdef __AVX2__
[[gnu::always_inline]] inline Pack4 four(const float* at) { return Pack4(_mm256_cvtps_pd(_mm_loadu_ps(at))); }
/// Lanes 0 and 1 of x, 2 and 3 of y.
[[gnu::always_inline]] inline Pack4 halves(const Pack4& x, const Pack4& y) {
  return Pack4(_mm256_blend_pd(x.v, y.v, 0b1100));
}
[[gnu::always_inline]] inline Six folded(const Pack4& a, const Pack4& ab, const Pack4& b) {
  const __m256d second = _mm256_permute2f128_pd(ab.v, b.v, 0x21);
  return {Pack4(a.v + second), _mm256_castpd256_pd128(ab.v) + _mm256_extractf128_pd(b.v, 1)};
}
#else
[[gnu::always_inline]] inline Pack4 four(const float* at) {
  const __m128 all = _mm_loadu_ps(at);
  return {_mm_cvtps_pd(all), _mm_cvtps_pd(_mm_movehl_ps(all, all))};
}
[[gnu::always_inline]] inline Pack4 halves(const Pack4& x, const Pack4& y) { return {x.lo, y.hi}; }
[[gnu::always_inline]] inline Six folded(const Pack4& a, const Pack4& ab, const Pack4& b) {
  return {{a.lo + ab.hi, a.hi + b.lo}, ab.lo + b.hi};
}
#endif

/// The sum over the eight corners of a cell; `weights`: the two ends of the edge along x at lower y and z, of
/// that at upper y, of that at upper z, of that at both. `stride`: from one corner's weight to the next.
template <typename T>
[[gnu::always_inline]] inline Six six_sum(const T* corner, std::size_t step_y, std::size_t step_z,
                                          const double* weights, std::size_t stride) {
  // Two sums, so that additions need not wait for one another.
  const auto end = [&](std::size_t i) { return Pack4::all(weights[i * stride]); };
  const auto edges = [&](const T* low, const T* high, std::size_t w) {
    const Pack4 a0 = end(w), b0 = end(w + 1), a1 = end(w + 2), b1 = end(w + 3);
    return std::array{a0 * four(low) + a1 * four(high),
                      halves(a0, b0) * four(low + 4) + halves(a1, b1) * four(high + 4),
                      b0 * four(low + 8) + b1 * four(high + 8)};
  };
  const auto lower = edges(corner, corner + step_y, 0);
  const auto upper = edges(corner + step_z, corner + step_y + step_z, 4);
  return folded(lower[0] + upper[0], lower[1] + upper[1], lower[2] + upper[2]);
}

/// Calls `put(i, weight)` for each of the eight weights of six_sum() at a place within a cell, all times
/// `scale`. Number: double or Pack4.
template <class Number, class Put>
[[gnu::always_inline]] inline void corner_weights(const Number& scale, const Number& fx, const Number& fy,
                                                  const Number& fz, const Put& put) {
  const Number z1 = scale * fz, z0 = scale - z1;
  const Number z0y1 = z0 * fy, z0y0 = z0 - z0y1, z1y1 = z1 * fy, z1y0 = z1 - z1y1;
  const Number w1 = z0y0 * fx, w3 = z0y1 * fx, w5 = z1y0 * fx, w7 = z1y1 * fx;
  put(0, z0y0 - w1);
  put(1, w1);
  put(2, z0y1 - w3);
  put(3, w3);
  put(4, z1y0 - w5);
  put(5, w5);
  put(6, z1y1 - w7);
  put(7, w7);
}

}  // namespace PALPATE_PACK
}  // namespace palpate
