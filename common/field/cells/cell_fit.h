/// The value at a point from those of the cells around it.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "common/math/vec.h"

namespace palpate {

/// A linear function through the values of cells at their centres, by weighted least squares: exact for linear
/// fields whatever the cells' shapes and sizes. (Barth and Jespersen, AIAA 89-0366, for gradients of cells.)
///
/// Lengths are measured against the cells around the point, direction by direction, so that layers of flat cells
/// count as cubes do; a cell's weight is one over the square of its centre's distance.
///
/// Its value at the point is limited: it stays in the range of the cells that touch the point, but for what any
/// linear function with its gradient leaves that range by. That is nothing where the point lies between their
/// centres, and the way to the border where it does not. So neither jumps nor noise make new extrema inside.
/// At the border the way counts in part where the line from a cell that touches the point leaves the range of all
/// cells at one of them by 2 % of it, and not at all from 15 % on: a jump beside the point is no slope towards it.
class CellFit {
 public:
  /// @param centres of the cells, from the point; the first `near` cells touch it, 0 < near.
  /// @param spread mean outer product of the vectors from the point to the corners of what touches it.
  void set(std::span<const Vec3> centres, std::size_t near, const Mat3& spread);

  /// Centres lie in a plane, or on a line, by what they are apart: no change along the normals to it.
  [[nodiscard]] bool flat() const noexcept { return flat_; }

  /// The value at the point from those of the cells, values[i * stride]. Not finite where one that touches is not.
  /// @pre the values of the others are finite.
  [[nodiscard]] double value(std::span<const double> values, std::size_t stride) const;

 private:
  /// Which part of the way to the border counts.
  [[nodiscard]] double linear_share(std::span<const double> values, std::size_t stride,
                                    const Vec3& gradient) const;

  std::vector<Vec3> y_;         ///< centres, in units of the spread
  std::vector<double> weight_;  ///< their sum is 1
  Vec3 mean_{0.0};
  Mat3 inverse_{0.0};  ///< of the moments about the mean
  std::size_t near_ = 0;
  bool flat_ = false;
};

}  // namespace palpate
