/// Lines of equal value on a slice of an image (image_resample.h), by marching squares.
///
/// Symbols.  h step of the lattice, f values along one of its edges, f'' their second derivative there.
///
/// A line runs straight through each square of four points, between places of its edges at which the linear
/// course from point to point has the value. Such a place is off along its edge by at most
///
///   e = h^2 max|f''| / 8 / |f_1 - f_0| * h                                                         (1)
///
/// with f'' from differences of neighbouring points. Where a slice lies across an axis of the image and has
/// its points, values are linear along edges, so that places are exact for trilinear data, and (1) is an
/// upper bound of the same estimate for whatever was sampled. Of squares with four crossings the value of the
/// bilinear saddle decides (Nielson and Hamann 1991).
#pragma once

#include <span>
#include <vector>

#include "common/field/data_set.h"
#include "common/math/vec.h"

namespace palpate {

struct ContourPoint {
  Vec3 position{0.0};  ///< data coordinates
  double error = 0.0;  ///< (1), and the rounding of single precision [data units]; > 0
};

/// A line, closed where its first point is its last one, too.
using ContourLine = std::vector<ContourPoint>;

/// The lines of `value` on a lattice of one layer. They end at its border and at points without a value.
/// @param values at its points, x fastest; NaN where there is none.
/// @pre lattice.points.z is 1; as many values as points.
[[nodiscard]] std::vector<ContourLine> contour_lines(const UniformTopology& lattice,
                                                     std::span<const float> values, double value);

}  // namespace palpate
