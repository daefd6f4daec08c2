/// Eigenvalues and eigenvectors of a symmetric 3x3 matrix.
///
/// Cyclic Jacobi rotations (Golub and Van Loan, Matrix Computations, sec. 8.5): every rotation is
/// orthogonal to rounding, so that eigenvectors are too, whatever the spectrum; equal and nearly equal
/// eigenvalues are no special case. Errors are a few units of rounding times the largest eigenvalue's size.
/// Matrices are scaled by a power of two first: entries from 1e-300 to 1e300 behave alike.
#pragma once

#include <array>

#include "common/math/vec.h"

namespace palpate {

/// The matrix of the six numbers xx, xy, xz, yy, yz, zz. @rt Safe.
[[nodiscard]] inline Mat3 symmetric_matrix(const std::array<double, 6>& d) noexcept {
  return {Vec3{d[0], d[1], d[2]}, Vec3{d[1], d[3], d[4]}, Vec3{d[2], d[4], d[5]}};
}

/// The six numbers xx, xy, xz, yy, yz, zz of its lower triangle. @rt Safe.
[[nodiscard]] inline std::array<double, 6> six_numbers(const Mat3& m) noexcept {
  return {m[0][0], m[1][0], m[2][0], m[1][1], m[2][1], m[2][2]};
}

/// A = V diag(values) V^T.
struct SymmetricEigen {
  Vec3 values{0.0};   ///< falling: values[0] >= values[1] >= values[2]
  Mat3 vectors{1.0};  ///< columns, orthonormal, right-handed; their signs have no meaning
};

/// Reads the lower triangle of `a` (a[c][r] with r >= c). NaN in gives NaN out. @rt Safe.
[[nodiscard]] SymmetricEigen symmetric_eigen(const Mat3& a) noexcept;

/// The eigenvalues alone, falling. @rt Safe.
[[nodiscard]] Vec3 symmetric_eigenvalues(const Mat3& a) noexcept;

}  // namespace palpate
