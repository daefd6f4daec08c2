/// The eigenframe of a diffusion tensor, and how it is carried along a path.
#pragma once

#include "common/math/symmetric3.h"
#include "common/math/vec.h"

namespace palpate {

/// How well the axes of a frame are told apart, in [0, 1]: 0 where an axis may be turned freely.
struct EigenGaps {
  double major = 0.0;  ///< of e_1: (lambda_1 - lambda_2) / lambda_1
  double minor = 0.0;  ///< of e_3: (lambda_2 - lambda_3) / lambda_1
};
/// @param eigenvalues falling; those below zero count as zero. Both gaps are 0 where nothing diffuses. @rt
/// Safe.
[[nodiscard]] EigenGaps eigen_gaps(const Vec3& eigenvalues) noexcept;

/// `frame` with the signs of its axes chosen so that e_1 and e_2 point as those of `before` do, and e_3
/// completes a right-handed frame. Eigenvectors have no sign of their own; along a path they must not flip.
/// @pre both orthonormal and right-handed, columns e_1, e_2, e_3. @rt Safe.
[[nodiscard]] Mat3 carried_frame(const Mat3& frame, const Mat3& before) noexcept;

/// The major eigenvector of the mean of the outer products d d^T, each with its weight: a mean of directions
/// without sign (Ikits 2006, sec. 8.2), and by how much it is defined.
class DirectionMean {
 public:
  /// Adds a direction of any length but zero. @rt Safe.
  void add(const Vec3& direction, double weight) noexcept;

  struct Result {
    Vec3 direction{0.0};  ///< unit; its sign has no meaning
    double gap = 0.0;     ///< 1 where all agree, 0 where it is undefined
  };
  /// Gap 0 where nothing was added. @rt Safe.
  [[nodiscard]] Result result() const noexcept;

 private:
  Mat3 sum_{0.0};
};

/// The logarithm. Eigenvalues below `floor` are lifted to it. @pre floor > 0. @rt Safe.
[[nodiscard]] Mat3 symmetric_log(const Mat3& tensor, double floor) noexcept;

/// The exponential. @rt Safe.
[[nodiscard]] Mat3 symmetric_exp(const Mat3& tensor) noexcept;

/// The tensor with its eigenvalues below zero replaced by zero. @rt Safe.
[[nodiscard]] Mat3 without_negative(const Mat3& tensor) noexcept;

}  // namespace palpate
