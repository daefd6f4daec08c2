/// Transfer functions of value and gradient magnitude as text, one region a row:
///
///   # comments and blank lines are passed over
///   box,V,M,V,M,R,G,B,A,S               two opposite corners
///   ellipse,V,M,V,M,R,G,B,A,S           those of the box about it
///   triangle,V,M,V,M,V,M,R,G,B,A,S      three corners
///
/// V value, M gradient magnitude [value / data unit], R,G,B colour (sRGB), A opacity, S soft border, the last
/// five in [0, 1]. After a row `fractions`, places 0 to 1 stand for the lowest to the highest value, and for
/// no gradient to the largest one of the data.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "common/field/region_transfer.h"

namespace palpate {

/// The ranges of values and of gradient magnitudes of the data: asked for only where places are fractions.
using DataRange = std::function<PlaceRange()>;

/// Whether the first row of `file` begins with a word of the grammar above; false where it cannot be read.
[[nodiscard]] bool is_region_file(const std::string& file);
/// @throws Error (bad input) naming the line that is no region.
[[nodiscard]] RegionTransfer read_regions(const std::string& file, const DataRange& range);
/// The text of a file that gives the same function back, bit by bit.
[[nodiscard]] std::string regions_text(const RegionTransfer& transfer);

/// The function on one line, as options and sessions have it: "regions:" and the rows, '/' between them.
[[nodiscard]] std::string region_words(const RegionTransfer& transfer);
/// What region_words() wrote, or a user; absent where `text` does not begin with "regions:".
/// @throws Error (usage) for rows that are none.
[[nodiscard]] std::optional<RegionTransfer> regions_from_words(const std::string& text,
                                                               const DataRange& range);

}  // namespace palpate
