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
#include <span>

#include "common/base/index.h"
#include "common/field/field_grid.h"
#include "common/field/tensor/tensor_field.h"
#include "common/trace/tract/face_steps.h"
#include "common/trace/tract/quad_kernel.h"
#include "common/trace/tract/six_sum.h"
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
  [[nodiscard]] FaceSteps faces(double tolerance) const { return {*field_->grid(), tolerance}; }

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
  UniformTensors(const TensorField& field, std::span<const T> values) noexcept : image_(field.grid().get()) {
    const FieldGrid& grid = *image_;
    const BoxGrid& box = *grid.box;
    grid_.values = values.data();
    grid_.scale = TractScale::of(field).tensor;
    grid_.turned = grid.frame.rotated || box.sheared();
    // Rows of B^-1 R^T: y of data coordinates.
    const Mat3 along = grid.frame.rotation * box.gradients();
    for (int axis = 0; axis < 3; ++axis) {
      const auto a = as_size(axis);
      const Vec3& e = along[axis];
      grid_.axes[a] = {e.x, e.y, e.z};
      const int last = box.points()[axis] - 1;
      grid_.origin[a] = box.coordinate(axis, 0);
      grid_.per_length[a] = last / (box.coordinate(axis, last) - grid_.origin[a]);
      grid_.top[a] = last;
      grid_.last_cell[a] = last - 1;
    }
    grid_.step_y = std::size_t{6} * as_size(box.points().x);
    grid_.step_z = grid_.step_y * as_size(box.points().y);
  }

  void forget() noexcept {}
  [[nodiscard]] FaceSteps faces(double tolerance) const { return {*image_, tolerance}; }
  [[nodiscard]] const TensorGrid<T>& grid() const noexcept { return grid_; }
  [[nodiscard]] SampleStatus sample(const Vec3& x, Tensor6& out) const noexcept {
    std::array<double, 3> f{};
    const T* corner = grid_.values;
    const std::array<std::size_t, 3> steps{6, grid_.step_y, grid_.step_z};
    for (std::size_t a = 0; a < 3; ++a) {
      const auto& e = grid_.axes[a];
      const double along = grid_.turned ? e[0] * x.x + e[1] * x.y + e[2] * x.z : x[static_cast<int>(a)];
      const double u = (along - grid_.origin[a]) * grid_.per_length[a];
      if (!(u >= 0.0 && u <= grid_.top[a])) return SampleStatus::kOutside;
      const int last = static_cast<int>(grid_.last_cell[a]);
      const int cell = static_cast<int>(u) < last ? static_cast<int>(u) : last;
      f[a] = u - cell;
      corner += steps[a] * as_size(cell);
    }
    std::array<double, 8> weights;
    corner_weights(grid_.scale, f[0], f[1], f[2],
                   [&weights](std::size_t i, double weight) { weights[i] = weight; });
    const Six sum = six_sum(corner, grid_.step_y, grid_.step_z, weights.data(), 1);
    out = {sum.first[0], sum.first[1], sum.first[2], sum.first[3], sum.last[0], sum.last[1]};
    // A corner without a tensor is NaN in some of its numbers; other numbers stay in range.
    if (std::isfinite(out.trace() + out.xy + out.xz + out.yz)) return SampleStatus::kOk;
    return without_missing(corner, {f[0], f[1], f[2]}, out);
  }

 private:
  /// The rule of TensorField::sample() for cells that lack some of their tensors.
  [[nodiscard]] SampleStatus without_missing(const T* corner, const Vec3& f, Tensor6& out) const noexcept {
    std::array<double, 6> sum{};
    double there = 0.0;
    for (unsigned c = 0; c < 8; ++c) {
      const bool x = (c & 1U) != 0, y = (c & 2U) != 0, z = (c & 4U) != 0;
      const T* const at = corner + (x ? 6 : 0) + (y ? grid_.step_y : 0) + (z ? grid_.step_z : 0);
      if (!std::all_of(at, at + 6, [](T number) { return std::isfinite(number); })) continue;
      const double weight = (x ? f.x : 1.0 - f.x) * (y ? f.y : 1.0 - f.y) * (z ? f.z : 1.0 - f.z);
      there += weight;
      for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += weight * static_cast<double>(at[i]);
    }
    if (!(there > 0.5)) return SampleStatus::kBadData;
    const double scale = grid_.scale / there;
    out = {scale * sum[0], scale * sum[1], scale * sum[2], scale * sum[3], scale * sum[4], scale * sum[5]};
    return SampleStatus::kOk;
  }

  const FieldGrid* image_;
  TensorGrid<T> grid_;
};

}  // namespace palpate
