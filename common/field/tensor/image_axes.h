/// The axes of an image as directions: what gradients and tensors that are given in image axes refer to.
#pragma once

#include "common/math/vec.h"

namespace palpate {

/// The rotation (or reflection) nearest to the directions of `axes`, whose columns are steps along i, j, k:
/// R = A (A^T A)^(-1/2) with A the unit columns. @pre they span space.
[[nodiscard]] Mat3 image_axes(const Mat3& axes) noexcept;

/// The axes that FSL means: those of the image, the first one turned around where the image is right-handed
/// (FSL's gradients and tensors are those of a left-handed, "radiological" image).
[[nodiscard]] Mat3 fsl_axes(const Mat3& axes) noexcept;

}  // namespace palpate
