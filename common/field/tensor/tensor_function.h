/// Functions of a symmetric tensor, through its eigenvalues.
#pragma once

#include "common/math/vec.h"

namespace palpate {

/// The logarithm. Eigenvalues below `floor` are lifted to it. @pre floor > 0. @rt Safe.
[[nodiscard]] Mat3 symmetric_log(const Mat3& tensor, double floor) noexcept;

/// The exponential. @rt Safe.
[[nodiscard]] Mat3 symmetric_exp(const Mat3& tensor) noexcept;

/// The tensor with its eigenvalues below zero replaced by zero. @rt Safe.
[[nodiscard]] Mat3 without_negative(const Mat3& tensor) noexcept;

}  // namespace palpate
