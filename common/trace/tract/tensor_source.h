/// Interpolated tensors for tracing, the same as TensorField::sample() to rounding.
///
/// Frame S: the data frame divided by the power of two of its local frame, not turned; tensors in its axes
/// and divided by a power of two so that their traces are near one at most. Images scaled by powers of two
/// give the same bits.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

#include <emmintrin.h>

#include "common/field/field_grid.h"
#include "common/field/tensor/tensor_field.h"
#include "common/trace/tract/tensor6.h"

namespace palpate {

/// What scales a field to frame S.
struct TractScale {
  int length_exponent = 0;
  double tensor = 1.0;  ///< power of two

  [[nodiscard]] static TractScale of(const TensorField& field) noexcept {
    return {field.frame().length_exponent, power_of_two(-binary_exponent(field.largest_trace()))};
  }
};

/// Any field, through TensorField::sample(). One for each thread: it remembers the last cell.
class AnyTensors {
 public:
  explicit AnyTensors(const TensorField& field) noexcept
      : field_(&field), scale_(TractScale::of(field)), length_(power_of_two(scale_.length_exponent)) {}

  /// The hint that a line starts with must not depend on the line before.
  void forget() noexcept { hint_ = {}; }
  [[nodiscard]] SampleStatus sample(const Vec3& x, Tensor6& out) noexcept {
    const TensorSample sample = field_->sample(x * length_, hint_);
    const Mat3& m = sample.value;
    const double s = scale_.tensor;
    out = {s * m[0][0], s * m[1][0], s * m[2][0], s * m[1][1], s * m[2][1], s * m[2][2]};
    return sample.status;
  }

 private:
  const TensorField* field_;
  TractScale scale_;
  double length_;
  CellHint hint_;
};

/// Components on a uniform grid, read where the field keeps them. T is the type of its numbers.
template <typename T>
class UniformTensors {
 public:
  /// @pre field.grid()->box, uniform; component-wise interpolation; values() of type T.
  UniformTensors(const TensorField& field, std::span<const T> values) noexcept : values_(values.data()) {
    const FieldGrid& grid = *field.grid();
    const BoxGrid& box = *grid.box;
    scale_ = TractScale::of(field).tensor;
    rotation_ = grid.frame.rotation;
    rotated_ = grid.frame.rotated;
    for (int axis = 0; axis < 3; ++axis) {
      const int last = box.points()[axis] - 1;
      origin_[axis] = box.coordinate(axis, 0);
      per_length_[axis] = last / (box.coordinate(axis, last) - origin_[axis]);
      top_[axis] = last;
      last_cell_[axis] = last - 1;
    }
    step_y_ = std::size_t{6} * static_cast<std::size_t>(box.points().x);
    step_z_ = step_y_ * static_cast<std::size_t>(box.points().y);
  }

  void forget() noexcept {}
  [[nodiscard]] SampleStatus sample(const Vec3& x, Tensor6& out) const noexcept {
    const Vec3 turned = rotated_ ? x * rotation_ : x;  // row vector times R is R^T times column
    const Vec3 u = (turned - origin_) * per_length_;
    if (!(u.x >= 0.0 && u.y >= 0.0 && u.z >= 0.0 && u.x <= top_.x && u.y <= top_.y && u.z <= top_.z)) {
      return SampleStatus::kOutside;
    }
    const int i = least(static_cast<int>(u.x), last_cell_.x);
    const int j = least(static_cast<int>(u.y), last_cell_.y);
    const int k = least(static_cast<int>(u.z), last_cell_.z);
    const T* const corner = values_ + std::size_t{6} * static_cast<std::size_t>(i) +
                            step_y_ * static_cast<std::size_t>(j) + step_z_ * static_cast<std::size_t>(k);
    const double fx = u.x - i, fy = u.y - j, fz = u.z - k;
    const double z1 = scale_ * fz, z0 = scale_ - z1;
    const double z0y1 = z0 * fy, z0y0 = z0 - z0y1, z1y1 = z1 * fy, z1y0 = z1 - z1y1;
    // Two sums, so that additions need not wait for one another.
    Six lower = edge(corner, fx, z0y0), upper = edge(corner + step_z_, fx, z1y0);
    add(lower, edge(corner + step_y_, fx, z0y1));
    add(upper, edge(corner + step_y_ + step_z_, fx, z1y1));
    add(lower, upper);
    out = {lower.a[0], lower.a[1], lower.b[0], lower.b[1], lower.c[0], lower.c[1]};
    // A corner without a tensor is NaN in some of its numbers; other numbers stay in range.
    if (std::isfinite(out.trace() + out.xy + out.xz + out.yz)) return SampleStatus::kOk;
    return without_missing(corner, {fx, fy, fz}, out);
  }

 private:
  struct Six {
    __m128d a, b, c;
  };
  static int least(int x, int y) noexcept { return x < y ? x : y; }
  static void add(Six& sum, const Six& more) noexcept {
    sum.a += more.a;
    sum.b += more.b;
    sum.c += more.c;
  }
  static __m128d two(const float* at) noexcept {
    return _mm_cvtps_pd(_mm_castsi128_ps(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(at))));
  }
  static __m128d two(const double* at) noexcept { return _mm_loadu_pd(at); }
  /// The rule of TensorField::sample() for cells that lack some of their tensors.
  [[nodiscard]] SampleStatus without_missing(const T* corner, const Vec3& f, Tensor6& out) const noexcept {
    std::array<double, 6> sum{};
    double there = 0.0;
    for (unsigned c = 0; c < 8; ++c) {
      const bool x = (c & 1U) != 0, y = (c & 2U) != 0, z = (c & 4U) != 0;
      const T* const at = corner + (x ? 6 : 0) + (y ? step_y_ : 0) + (z ? step_z_ : 0);
      if (!std::all_of(at, at + 6, [](T number) { return std::isfinite(number); })) continue;
      const double weight = (x ? f.x : 1.0 - f.x) * (y ? f.y : 1.0 - f.y) * (z ? f.z : 1.0 - f.z);
      there += weight;
      for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += weight * static_cast<double>(at[i]);
    }
    if (!(there > 0.5)) return SampleStatus::kBadData;
    const double scale = scale_ / there;
    out = {scale * sum[0], scale * sum[1], scale * sum[2], scale * sum[3], scale * sum[4], scale * sum[5]};
    return SampleStatus::kOk;
  }
  /// The tensors at the ends of a cell's edge along x, weighted. Inlined: a call would pass six numbers
  /// through memory, four times a sample.
  [[gnu::always_inline]] static Six edge(const T* at, double fx, double weight) noexcept {
    const double second = weight * fx, first = weight - second;
    const __m128d w0{first, first}, w1{second, second};
    return {w0 * two(at) + w1 * two(at + 6), w0 * two(at + 2) + w1 * two(at + 8),
            w0 * two(at + 4) + w1 * two(at + 10)};
  }

  const T* values_;
  Mat3 rotation_{1.0};
  bool rotated_ = false;
  Vec3 origin_{0.0}, per_length_{1.0}, top_{0.0};
  Index3 last_cell_{0};
  std::size_t step_y_ = 0, step_z_ = 0;
  double scale_ = 1.0;
};

}  // namespace palpate
