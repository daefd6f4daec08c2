/// Weighted means of symmetric tensors, for interpolation.
#pragma once

#include <span>

#include "common/math/vec.h"

namespace palpate {

/// How tensors between the points of a grid are made.
enum class TensorInterpolation : unsigned char {
  kComponents,   ///< sum_i w_i D_i: the interpolant of each component
  kLogEuclidean  ///< exp(sum_i w_i log D_i): determinants between those of the points (Arsigny et al. 2006)
};

/// The logarithm of a symmetric tensor. Eigenvalues that are not above `floor` times the largest are taken as
/// that: fitted tensors have zero and negative ones. @pre some eigenvalue is above zero; 0 < floor < 1. @rt
/// Safe.
[[nodiscard]] Mat3 symmetric_log(const Mat3& tensor, double floor = 1e-6) noexcept;

/// The exponential of a symmetric tensor. @rt Safe.
[[nodiscard]] Mat3 symmetric_exp(const Mat3& tensor) noexcept;

/// The mean of `tensors` with `weights` that add up to one. Tensors without an eigenvalue above zero have no
/// logarithm: with one of them among those of weight, the mean is that of the components.
/// @pre as many weights as tensors. @rt Safe.
[[nodiscard]] Mat3 tensor_mean(std::span<const Mat3> tensors, std::span<const double> weights,
                               TensorInterpolation how) noexcept;

}  // namespace palpate
