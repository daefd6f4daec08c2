/// What single precision leaves open of the values of a field, and of the places of its points.
///
/// Numbers of 16 bits or fewer (whole ones of 8 and 16 bits, and such parts of two) do not come about by rounding: where a list
/// has no others, none of it was rounded.
#pragma once

#include <span>

#include "common/field/data_set.h"

namespace palpate {

/// By which part of itself a value of a field may be off that is held in single precision: half a unit in the last place from
/// the file, and as much again where values are brought to the points, or divided. Doubles: nothing that counts.
[[nodiscard]] double value_rounding(std::span<const float> values) noexcept;
[[nodiscard]] inline double value_rounding(std::span<const double>) noexcept { return 0.0; }

/// By how much the coordinates of a block's points may be off, in data units: half a unit in the last place of the largest.
/// Those of rectilinear blocks are of single precision where it holds them all. 0 for images.
[[nodiscard]] double point_rounding(const DataSet& block);

}  // namespace palpate
