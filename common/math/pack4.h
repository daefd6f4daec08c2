/// Four doubles side by side: barycentric coordinates, or a position with its time.
///
/// Two SSE registers on baseline x86-64, where a 32-byte vector type would change the calling convention, and
/// one AVX register in what is compiled with -mavx2 (exact_kernel.h). The two are types of different
/// namespaces, with the same lanes and the same results bit for bit.
#pragma once

#include <array>
#include <cstdint>
#include <cstring>

#ifdef __AVX2__
#include <immintrin.h>
#else
#include <emmintrin.h>
#endif

#include "common/math/vec.h"

#ifdef __AVX2__
#define PALPATE_PACK avx2
#else
#define PALPATE_PACK sse2
#endif

namespace palpate {
inline namespace PALPATE_PACK {

#ifdef __AVX2__

/// The outcome of a comparison: each lane all ones or all zeros.
struct Mask4 {
  __m256d v;
};

struct Pack4 {
  __m256d v{0.0, 0.0, 0.0, 0.0};

  Pack4() = default;
  explicit Pack4(__m256d lanes) : v(lanes) {}
  Pack4(double a, double b, double c, double d) : v{a, b, c, d} {}
  [[nodiscard]] static Pack4 all(double a) { return {a, a, a, a}; }
  [[nodiscard]] static Pack4 load(const double* lanes) { return Pack4(_mm256_loadu_pd(lanes)); }
  /// What was stored in halves a moment ago: a load of both at once would have to wait for the cache.
  [[nodiscard]] static Pack4 load_halves(const double* lanes) {
    return Pack4(
        _mm256_insertf128_pd(_mm256_castpd128_pd256(_mm_loadu_pd(lanes)), _mm_loadu_pd(lanes + 2), 1));
  }
  [[nodiscard]] static Pack4 load(const std::array<double, 4>& lanes) { return load(lanes.data()); }
  void store(std::array<double, 4>& lanes) const { store(lanes.data()); }
  void store(double* lanes) const { _mm256_storeu_pd(lanes, v); }

  [[nodiscard]] double operator[](int i) const { return v[i]; }

  Pack4& operator+=(const Pack4& y) {
    v += y.v;
    return *this;
  }
};

inline Pack4 operator+(const Pack4& x, const Pack4& y) { return Pack4(x.v + y.v); }
inline Pack4 operator-(const Pack4& x, const Pack4& y) { return Pack4(x.v - y.v); }
inline Pack4 operator*(const Pack4& x, const Pack4& y) { return Pack4(x.v * y.v); }
inline Pack4 operator/(const Pack4& x, const Pack4& y) { return Pack4(x.v / y.v); }
inline Pack4 operator*(double a, const Pack4& x) { return Pack4(_mm256_set1_pd(a) * x.v); }

[[nodiscard]] inline Pack4 sqrt(const Pack4& x) { return Pack4(_mm256_sqrt_pd(x.v)); }
[[nodiscard]] inline Pack4 abs(const Pack4& x) { return Pack4(_mm256_andnot_pd(_mm256_set1_pd(-0.0), x.v)); }
/// x < y ? x : y, so the second where either is NaN.
[[nodiscard]] inline Pack4 min(const Pack4& x, const Pack4& y) { return Pack4(_mm256_min_pd(x.v, y.v)); }
[[nodiscard]] inline Pack4 max(const Pack4& x, const Pack4& y) { return Pack4(_mm256_max_pd(x.v, y.v)); }
/// Lanes a, b, c, d of x.
template <int a, int b, int c, int d>
[[nodiscard]] inline Pack4 lanes(const Pack4& x) {
  return Pack4(_mm256_permute4x64_pd(x.v, a | b << 2 | c << 4 | d << 6));
}

[[nodiscard]] inline Mask4 operator<(const Pack4& x, const Pack4& y) {
  return {_mm256_cmp_pd(x.v, y.v, _CMP_LT_OQ)};
}
[[nodiscard]] inline Mask4 operator<=(const Pack4& x, const Pack4& y) {
  return {_mm256_cmp_pd(x.v, y.v, _CMP_LE_OQ)};
}
[[nodiscard]] inline Mask4 operator==(const Pack4& x, const Pack4& y) {
  return {_mm256_cmp_pd(x.v, y.v, _CMP_EQ_OQ)};
}
[[nodiscard]] inline Mask4 operator&(const Mask4& x, const Mask4& y) { return {_mm256_and_pd(x.v, y.v)}; }
[[nodiscard]] inline Mask4 operator|(const Mask4& x, const Mask4& y) { return {_mm256_or_pd(x.v, y.v)}; }
/// Bit i is set where lane i is.
[[nodiscard]] inline unsigned bits(const Mask4& x) { return static_cast<unsigned>(_mm256_movemask_pd(x.v)); }
[[nodiscard]] inline Pack4 select(const Mask4& where, const Pack4& x, const Pack4& y) {
  return Pack4(_mm256_blendv_pd(y.v, x.v, where.v));
}

#else

using Pack2 = __m128d;

/// The outcome of a comparison: each lane all ones or all zeros.
struct Mask4 {
  Pack2 lo, hi;
};

struct Pack4 {
  Pack2 lo{0.0, 0.0};
  Pack2 hi{0.0, 0.0};

  Pack4() = default;
  Pack4(Pack2 low, Pack2 high) : lo(low), hi(high) {}
  Pack4(double a, double b, double c, double d) : lo{a, b}, hi{c, d} {}
  Pack4(const Vec3& x, double w) : lo{x.x, x.y}, hi{x.z, w} {}
  [[nodiscard]] static Pack4 all(double a) { return {a, a, a, a}; }
  [[nodiscard]] static Pack4 load(const double* lanes) {
    return {_mm_loadu_pd(lanes), _mm_loadu_pd(lanes + 2)};
  }
  [[nodiscard]] static Pack4 load_halves(const double* lanes) { return load(lanes); }
  [[nodiscard]] static Pack4 load(const std::array<double, 4>& lanes) { return load(lanes.data()); }
  void store(std::array<double, 4>& lanes) const { store(lanes.data()); }
  void store(double* lanes) const {
    _mm_storeu_pd(lanes, lo);
    _mm_storeu_pd(lanes + 2, hi);
  }

  [[nodiscard]] double operator[](int i) const { return i < 2 ? lo[i] : hi[i - 2]; }
  void set(int i, double value) {
    if (i < 2) {
      lo[i] = value;
    } else {
      hi[i - 2] = value;
    }
  }
  [[nodiscard]] Vec3 xyz() const { return {lo[0], lo[1], hi[0]}; }

  Pack4& operator+=(const Pack4& y) {
    lo += y.lo;
    hi += y.hi;
    return *this;
  }
};

inline Pack4 operator+(const Pack4& x, const Pack4& y) { return {x.lo + y.lo, x.hi + y.hi}; }
inline Pack4 operator-(const Pack4& x, const Pack4& y) { return {x.lo - y.lo, x.hi - y.hi}; }
inline Pack4 operator*(const Pack4& x, const Pack4& y) { return {x.lo * y.lo, x.hi * y.hi}; }
inline Pack4 operator/(const Pack4& x, const Pack4& y) { return {x.lo / y.lo, x.hi / y.hi}; }
inline Pack4 operator*(double a, const Pack4& x) {
  const Pack2 aa{a, a};
  return {aa * x.lo, aa * x.hi};
}

[[nodiscard]] inline Pack4 sqrt(const Pack4& x) { return {_mm_sqrt_pd(x.lo), _mm_sqrt_pd(x.hi)}; }
[[nodiscard]] inline Pack4 abs(const Pack4& x) {
  const Pack2 sign = _mm_set1_pd(-0.0);
  return {_mm_andnot_pd(sign, x.lo), _mm_andnot_pd(sign, x.hi)};
}
/// x < y ? x : y, so the second where either is NaN.
[[nodiscard]] inline Pack4 min(const Pack4& x, const Pack4& y) {
  return {_mm_min_pd(x.lo, y.lo), _mm_min_pd(x.hi, y.hi)};
}
[[nodiscard]] inline Pack4 max(const Pack4& x, const Pack4& y) {
  return {_mm_max_pd(x.lo, y.lo), _mm_max_pd(x.hi, y.hi)};
}
/// Lanes a, b, c, d of x.
template <int a, int b, int c, int d>
[[nodiscard]] inline Pack4 lanes(const Pack4& x) {
  const auto pair = [&]<int i, int j>() {
    return _mm_shuffle_pd(i < 2 ? x.lo : x.hi, j < 2 ? x.lo : x.hi, (i & 1) | (j & 1) << 1);
  };
  return {pair.template operator()<a, b>(), pair.template operator()<c, d>()};
}

[[nodiscard]] inline Mask4 operator<(const Pack4& x, const Pack4& y) {
  return {_mm_cmplt_pd(x.lo, y.lo), _mm_cmplt_pd(x.hi, y.hi)};
}
[[nodiscard]] inline Mask4 operator<=(const Pack4& x, const Pack4& y) {
  return {_mm_cmple_pd(x.lo, y.lo), _mm_cmple_pd(x.hi, y.hi)};
}
[[nodiscard]] inline Mask4 operator==(const Pack4& x, const Pack4& y) {
  return {_mm_cmpeq_pd(x.lo, y.lo), _mm_cmpeq_pd(x.hi, y.hi)};
}
[[nodiscard]] inline Mask4 operator&(const Mask4& x, const Mask4& y) {
  return {_mm_and_pd(x.lo, y.lo), _mm_and_pd(x.hi, y.hi)};
}
[[nodiscard]] inline Mask4 operator|(const Mask4& x, const Mask4& y) {
  return {_mm_or_pd(x.lo, y.lo), _mm_or_pd(x.hi, y.hi)};
}
/// Bit i is set where lane i is.
[[nodiscard]] inline unsigned bits(const Mask4& x) {
  return static_cast<unsigned>(_mm_movemask_pd(x.lo) | _mm_movemask_pd(x.hi) << 2);
}
[[nodiscard]] inline Pack4 select(const Mask4& where, const Pack4& x, const Pack4& y) {
  const auto one = [](Pack2 m, Pack2 a, Pack2 b) { return _mm_or_pd(_mm_and_pd(m, a), _mm_andnot_pd(m, b)); };
  return {one(where.lo, x.lo, y.lo), one(where.hi, x.hi, y.hi)};
}

/// Where the four numbers at `four` equal `value`.
[[nodiscard]] inline Mask4 equal(const std::uint32_t* four, std::uint32_t value) {
  const __m128i same = _mm_cmpeq_epi32(_mm_loadu_si128(reinterpret_cast<const __m128i*>(four)),
                                       _mm_set1_epi32(static_cast<int>(value)));
  return {_mm_castsi128_pd(_mm_unpacklo_epi32(same, same)), _mm_castsi128_pd(_mm_unpackhi_epi32(same, same))};
}

#endif

[[nodiscard]] inline double max_lane(const Pack4& x) {
  const auto larger = [](double a, double b) { return a > b ? a : b; };
  return larger(larger(x[0], x[2]), larger(x[1], x[3]));
}
[[nodiscard]] inline double min_lane(const Pack4& x) {
  const auto smaller = [](double a, double b) { return a < b ? a : b; };
  return smaller(smaller(x[0], x[2]), smaller(x[1], x[3]));
}
[[nodiscard]] inline double max_abs(const Pack4& x) { return max_lane(abs(x)); }
/// Scalar product of the first three lanes.
[[nodiscard]] inline double dot3(const Pack4& x, const Pack4& y) {
  const Pack4 product = x * y;
  return product[0] + product[1] + product[2];
}

}  // namespace PALPATE_PACK
}  // namespace palpate
