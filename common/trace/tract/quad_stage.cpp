// Compiled twice, see quad_kernel.h: nothing here may be shared with other files.
#include <array>
#include <cstddef>
#include <cstdint>

#include "common/base/index.h"
#include "common/trace/tract/main_direction_rule.h"
#include "common/trace/tract/quad_kernel.h"
#include "common/trace/tract/six_sum.h"

namespace palpate {
inline namespace PALPATE_PACK {
namespace {

using Lanes = std::array<double, 4>;

/// Rounded towards zero. @pre in the range of int.
Pack4 truncated(const Pack4& x) {
#ifdef __AVX2__
  return Pack4(_mm256_cvtepi32_pd(_mm256_cvttpd_epi32(x.v)));
#else
  return {_mm_cvtepi32_pd(_mm_cvttpd_epi32(x.lo)), _mm_cvtepi32_pd(_mm_cvttpd_epi32(x.hi))};
#endif
}

/// From a tensor a lane to a component a pack.
void transpose(const std::array<Six, 4>& t, Tensors4& out) {
#ifdef __AVX2__
  const __m256d ab_even = _mm256_unpacklo_pd(t[0].first.v, t[1].first.v);
  const __m256d ab_odd = _mm256_unpackhi_pd(t[0].first.v, t[1].first.v);
  const __m256d cd_even = _mm256_unpacklo_pd(t[2].first.v, t[3].first.v);
  const __m256d cd_odd = _mm256_unpackhi_pd(t[2].first.v, t[3].first.v);
  Pack4(_mm256_permute2f128_pd(ab_even, cd_even, 0x20)).store(out.xx);
  Pack4(_mm256_permute2f128_pd(ab_odd, cd_odd, 0x20)).store(out.xy);
  Pack4(_mm256_permute2f128_pd(ab_even, cd_even, 0x31)).store(out.xz);
  Pack4(_mm256_permute2f128_pd(ab_odd, cd_odd, 0x31)).store(out.yy);
  const auto both = [](__m128d low, __m128d high) { return Pack4(_mm256_set_m128d(high, low)); };
#else
  const auto both = [](__m128d low, __m128d high) { return Pack4(low, high); };
  const std::array<Pack4, 4> f{t[0].first, t[1].first, t[2].first, t[3].first};
  both(_mm_unpacklo_pd(f[0].lo, f[1].lo), _mm_unpacklo_pd(f[2].lo, f[3].lo)).store(out.xx);
  both(_mm_unpackhi_pd(f[0].lo, f[1].lo), _mm_unpackhi_pd(f[2].lo, f[3].lo)).store(out.xy);
  both(_mm_unpacklo_pd(f[0].hi, f[1].hi), _mm_unpacklo_pd(f[2].hi, f[3].hi)).store(out.xz);
  both(_mm_unpackhi_pd(f[0].hi, f[1].hi), _mm_unpackhi_pd(f[2].hi, f[3].hi)).store(out.yy);
#endif
  both(_mm_unpacklo_pd(t[0].last, t[1].last), _mm_unpacklo_pd(t[2].last, t[3].last)).store(out.yz);
  both(_mm_unpackhi_pd(t[0].last, t[1].last), _mm_unpackhi_pd(t[2].last, t[3].last)).store(out.zz);
}

template <typename T>
unsigned sample(const TensorGrid<T>& image, const Vectors4& at, Tensors4& out) noexcept {
  const std::array<Pack4, 3> x{Pack4::load(at.x), Pack4::load(at.y), Pack4::load(at.z)};
  std::array<Pack4, 3> f;
  std::array<Lanes, 3> cell;
  Mask4 inside;
  const Pack4 zero;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    Pack4 along = x[axis];
    if (image.turned) {
      const auto& e = image.axes[axis];
      along = e[0] * x[0] + e[1] * x[1] + e[2] * x[2];
    }
    const Pack4 u = (along - Pack4::all(image.origin[axis])) * Pack4::all(image.per_length[axis]);
    const Mask4 here = (zero <= u) & (u <= Pack4::all(image.top[axis]));
    inside = axis == 0 ? here : inside & here;
    const Pack4 kept = select(here, u, zero);  // lanes outside read the first cell
    const Pack4 low = min(truncated(kept), Pack4::all(image.last_cell[axis]));
    f[axis] = kept - low;
    low.store(cell[axis]);
  }
  alignas(32) std::array<Lanes, 8> w;
  corner_weights(Pack4::all(image.scale), f[0], f[1], f[2],
                 [&w](std::size_t i, const Pack4& weight) { weight.store(w[i]); });
  std::array<Six, 4> sums;
  for (std::size_t lane = 0; lane < 4; ++lane) {
    const T* const corner = image.values + std::size_t{6} * floor_size(cell[0][lane]) +
                            image.step_y * floor_size(cell[1][lane]) +
                            image.step_z * floor_size(cell[2][lane]);
    sums[lane] = six_sum(corner, image.step_y, image.step_z, &w[0][lane], 4);
  }
  transpose(sums, out);
  const Pack4 sum = Pack4::load(out.xx) + Pack4::load(out.yy) + Pack4::load(out.zz) + Pack4::load(out.xy) +
                    Pack4::load(out.xz) + Pack4::load(out.yz);
  // Nothing times a number is nothing, unless that is infinite or none.
  return bits(inside & (zero * sum == zero));
}

}  // namespace

unsigned sample_four(const TensorGrid<float>& image, const Vectors4& at, Tensors4& out) noexcept {
  return sample(image, at, out);
}
unsigned sample_four(const TensorGrid<double>& image, const Vectors4& at, Tensors4& out) noexcept {
  return sample(image, at, out);
}

unsigned directions_of_four(const Tensors4& d, const Vectors4& toward, unsigned wanted,
                            Vectors4& found) noexcept {
  const Pack4 xx = Pack4::load(d.xx), xy = Pack4::load(d.xy), xz = Pack4::load(d.xz), yy = Pack4::load(d.yy),
              yz = Pack4::load(d.yz), zz = Pack4::load(d.zz);
  const Pack4 tx = Pack4::load(toward.x), ty = Pack4::load(toward.y), tz = Pack4::load(toward.z);
  const Pack4 trace = xx + yy + zz;
  Pack4 vx = tx, vy = ty, vz = tz, length2 = Pack4::all(1.0), gap;
  const auto quotient = [&] {
    return vx * (xx * vx + xy * vy + xz * vz) + vy * (xy * vx + yy * vy + yz * vz) +
           vz * (xz * vx + yz * vy + zz * vz);
  };
  Pack4 rho = quotient();
  Mask4 settled = length2 < Pack4();  // none
  for (int step = 0; step < direction_rule::kMostSteps; ++step) {
    const Pack4 x = xx - rho, y = yy - rho, z = zz - rho;
    const Pack4 axx = y * z - yz * yz, axy = xz * yz - xy * z, axz = xy * yz - xz * y, ayy = x * z - xz * xz,
                ayz = xy * xz - x * yz, azz = x * y - xy * xy;
    const Pack4 nx = axx * vx + axy * vy + axz * vz, ny = axy * vx + ayy * vy + ayz * vz,
                nz = axz * vx + ayz * vy + azz * vz;
    const Pack4 next2 = nx * nx + ny * ny + nz * nz, along = vx * nx + vy * ny + vz * nz;
    const Mask4 now =
        next2 * length2 - along * along < Pack4::all(direction_rule::kTurnDone) * next2 * length2;
    // What has settled stays: a lane must not depend on the others.
    vx = select(settled, vx, nx);
    vy = select(settled, vy, ny);
    vz = select(settled, vz, nz);
    length2 = select(settled, length2, next2);
    gap = select(settled, gap, axx + ayy + azz);
    settled = settled | now;
    if ((bits(settled) & wanted) == wanted) break;
    rho = select(settled, rho, quotient() / length2);
  }
  const Mask4 certified = settled & (Pack4::all(direction_rule::kLeastGap) * trace * trace < gap) &
                          (trace < Pack4::all(3.0) * rho);
  const Mask4 against = vx * tx + vy * ty + vz * tz < Pack4();
  const Pack4 factor = select(against, Pack4::all(-1.0), Pack4::all(1.0)) / sqrt(length2);
  (vx * factor).store(found.x);
  (vy * factor).store(found.y);
  (vz * factor).store(found.z);
  return bits(certified) & wanted;
}

unsigned positive_of_four(const Tensors4& d, double cutoff, unsigned& above) noexcept {
  const Pack4 xx = Pack4::load(d.xx), xy = Pack4::load(d.xy), xz = Pack4::load(d.xz), yy = Pack4::load(d.yy),
              yz = Pack4::load(d.yz), zz = Pack4::load(d.zz), zero;
  const Pack4 minor = xx * yy - xy * xy;
  const Pack4 determinant = zz * minor - xx * yz * yz - yy * xz * xz + Pack4::all(2.0) * xy * xz * yz;
  const Mask4 positive = (zero < xx) & (zero < minor) & (zero < determinant);
  const Pack4 mean = (xx + yy + zz) / Pack4::all(3.0);
  const Pack4 off = Pack4::all(2.0) * (xy * xy + xz * xz + yz * yz);
  const Pack4 x = xx - mean, y = yy - mean, z = zz - mean;
  const Pack4 all = xx * xx + yy * yy + zz * zz + off;
  const Pack4 least = Pack4::all(cutoff * cutoff) * all;
  above = bits(positive & (least <= Pack4::all(1.5) * (x * x + y * y + z * z + off)));
  return bits(positive);
}

}  // namespace PALPATE_PACK
}  // namespace palpate
