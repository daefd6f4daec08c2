/// The diffusion weighting of a series of volumes.
///
/// Symbols: b_i diffusion weighting of volume i [s/mm^2]; g_i unit gradient direction in the axes of the data
/// frame X (RAS for medical images), zero where the volume has none.
#pragma once

#include <vector>

#include "common/math/vec.h"

namespace palpate {

struct GradientTable {
  std::vector<double> weightings;  ///< b_i, not below zero
  std::vector<Vec3> directions;    ///< g_i, as many

  [[nodiscard]] double largest_weighting() const noexcept;
  /// Whether volume i counts as not weighted: b_i below a twentieth of the largest (scanners write small
  /// values for zero), or no direction.
  [[nodiscard]] bool unweighted(std::size_t i) const noexcept;
  [[nodiscard]] std::size_t unweighted_count() const noexcept;
};

/// Most volumes that a table may have: what a file or helper program claims beyond is refused.
inline constexpr std::size_t kMostGradients = 4096;

// The axes of an image as directions: what gradients and tensors that are given in image axes refer to.

/// The rotation (or reflection) nearest to the directions of `axes`, whose columns are steps along i, j, k:
/// R = A (A^T A)^(-1/2) with A the unit columns. @pre they span space.
[[nodiscard]] Mat3 image_axes(const Mat3& axes) noexcept;

/// The axes that FSL means: those of the image, the first one turned around where the image is right-handed
/// (FSL's gradients and tensors are those of a left-handed, "radiological" image).
[[nodiscard]] Mat3 fsl_axes(const Mat3& axes) noexcept;

}  // namespace palpate
