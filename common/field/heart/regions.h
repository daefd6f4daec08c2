/// Regions of a heart's mesh, by the numbers that its elements have: ventricle, scar, bath, torso.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "common/field/data_set.h"

namespace palpate {

struct RegionCount {
  double number = 0.0;
  std::size_t elements = 0;
  bool left_out = false;  ///< as it has no fibres

  bool operator==(const RegionCount&) const = default;
};

/// The regions of an array of elements, by rising number; elements whose number is not finite are of none.
/// More than kMostHeartRegions are no regions: nothing.
[[nodiscard]] std::vector<RegionCount> count_regions(const DataArray& numbers);
inline constexpr std::size_t kMostHeartRegions = 1000;

/// "1,2,10": numbers with commas between. Empty: none. @throws Error (usage) for anything else.
[[nodiscard]] std::vector<double> parse_regions(const std::string& text);
/// The same as text, by rising number.
[[nodiscard]] std::string regions_text(std::vector<double> numbers);

/// Hides (DataSet::hidden_cells) the cells of all regions but those that are `chosen`, beside what is hidden.
/// @param numbers of each cell.
/// @return how many it hid.
std::size_t hide_other_regions(DataSet& mesh, const DataArray& numbers, const std::vector<double>& chosen);

}  // namespace palpate
