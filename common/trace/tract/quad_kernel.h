/// Four lines through a uniform image of tensors, side by side: what a step does most, once for the baseline
/// and once for processors with AVX2, chosen when the program runs.
///
/// A step waits for its own results: sample, eigenvector, cut-off, one after the other. Four lines fill the
/// gaps, and share instructions. Lanes do not know of one another, and both kernels give the bits that
/// UniformTensors::sample(), main_direction() and reaches() give: lines do not depend on the processor or on
/// their neighbours.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string_view>

#include "common/math/pack4.h"

namespace palpate {

/// A uniform image as a kernel reads it. Frame S of tensor_source.h.
template <typename T>
struct TensorGrid {
  const T* values = nullptr;  ///< six a point, xx xy xz yy yz zz, x fastest
  std::size_t step_y = 0, step_z = 0;
  double scale = 1.0;   ///< of the tensors, a power of two
  bool turned = false;  ///< or sheared
  /// Where turned: products with places are coordinates along the axes.
  std::array<std::array<double, 3>, 3> axes{};
  std::array<double, 3> origin{}, per_length{};
  std::array<double, 3> top{};        ///< index of the last point along each axis
  std::array<double, 3> last_cell{};  ///< top - 1
};

/// Four places or directions.
struct Vectors4 {
  alignas(32) std::array<double, 4> x{};
  alignas(32) std::array<double, 4> y{};
  alignas(32) std::array<double, 4> z{};
};

/// Four tensors.
struct Tensors4 {
  alignas(32) std::array<double, 4> xx{};
  alignas(32) std::array<double, 4> xy{};
  alignas(32) std::array<double, 4> xz{};
  alignas(32) std::array<double, 4> yy{};
  alignas(32) std::array<double, 4> yz{};
  alignas(32) std::array<double, 4> zz{};
};

/// The functions of one kind of processor. A set of lanes is a number with bit i for lane i. @rt Safe, all.
struct QuadKernel {
  std::string_view name;
  /// Interpolated tensors; returns the lanes that lie inside and got six finite numbers, the others are to be
  /// asked of UniformTensors::sample().
  unsigned (*sample_float)(const TensorGrid<float>& image, const Vectors4& at, Tensors4& out) noexcept;
  unsigned (*sample_double)(const TensorGrid<double>& image, const Vectors4& at, Tensors4& out) noexcept;
  /// Main eigenvectors of the lanes `wanted`, as main_direction(); returns those of them that are certified.
  unsigned (*directions)(const Tensors4& d, const Vectors4& toward, unsigned wanted,
                         Vectors4& found) noexcept;
  /// Lanes whose tensor is positive, and `above`, those of them with an FA of `cutoff` or more.
  unsigned (*positive)(const Tensors4& d, double cutoff, unsigned& above) noexcept;
};

/// Those that this processor runs, the baseline first.
[[nodiscard]] std::span<const QuadKernel> quad_kernels() noexcept;
/// The fastest of them.
[[nodiscard]] inline const QuadKernel& quad_kernel() noexcept { return quad_kernels().back(); }

inline namespace PALPATE_PACK {

/// @name The functions of QuadKernel, compiled once for each kind of processor
/// @{
[[nodiscard]] unsigned sample_four(const TensorGrid<float>& image, const Vectors4& at,
                                   Tensors4& out) noexcept;
[[nodiscard]] unsigned sample_four(const TensorGrid<double>& image, const Vectors4& at,
                                   Tensors4& out) noexcept;
[[nodiscard]] unsigned directions_of_four(const Tensors4& d, const Vectors4& toward, unsigned wanted,
                                          Vectors4& found) noexcept;
[[nodiscard]] unsigned positive_of_four(const Tensors4& d, double cutoff, unsigned& above) noexcept;
/// @}

}  // namespace PALPATE_PACK
}  // namespace palpate
