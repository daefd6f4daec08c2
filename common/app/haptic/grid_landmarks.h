/// Where the values of a volume pile up along an axis: landmarks for a haptic grid.
#pragma once

#include <vector>

#include "common/field/scalar_field.h"
#include "common/math/vec.h"

namespace palpate {

/// Positions along `axes[axis]` (e . x, data units, from the origin of the coordinates) of the most prominent
/// peaks of
///
///   m(s) = mean of the values above the lowest one on the plane e . x = s,
///
/// sampled on a lattice of 192 planes of 32 x 32 places and smoothed over five planes: the weight that the
/// histogram of the positions e . x has where each place counts by its value. Peaks that stand out by less
/// than a fiftieth of the range of m are none; a border is none.
/// @param axes orthonormal, columns, data frame.  @return at most `count`, ascending.
[[nodiscard]] std::vector<double> value_peaks(const ScalarField& field, const Mat3& axes, int axis,
                                              int count);

}  // namespace palpate
