/// Where an image shows something: a head before dark surroundings.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "common/math/vec.h"

namespace palpate {

/// A byte a voxel, 1 in the foreground: values above Otsu's threshold (values brighter than 98 of 100 others
/// count as those, so that a few bright ones do not lift it), of these the largest part that hangs together
/// through faces, with its holes filled, those of single slices along each axis too. Values that are not
/// finite are background. Where all values are alike everything is foreground.
/// @param values the first axis fastest. @pre values.size() is the product of `points`.
[[nodiscard]] std::vector<std::uint8_t> foreground_mask(std::span<const float> values, const Index3& points);

}  // namespace palpate
