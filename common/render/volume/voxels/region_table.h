/// Transfer functions of value and gradient magnitude as shaders look them up (shaders/volume/regions.glsl).
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "common/field/transfer/region_transfer.h"
#include "common/render/volume/table/preintegration.h"

namespace palpate {

/// Entries along gradient magnitudes.
inline constexpr std::size_t kGradientEntries = 256;

/// Entries at equally spaced values and magnitudes, both ends included.
struct RegionTable {
  std::size_t columns = 0, rows = 0;          ///< of values and of magnitudes
  std::vector<std::array<float, 4>> entries;  ///< red, green, blue times depth, depth; values fastest

  [[nodiscard]] bool clear(std::size_t column, std::size_t row) const noexcept {
    return entries[column + columns * row][3] == 0.0F;
  }
};

/// `transfer` between places `range`, with optical depths for its reference length.
/// The result does not depend on the number of threads. @pre at least two columns.
[[nodiscard]] RegionTable make_region_table(const RegionTransfer& transfer, const PlaceRange& range,
                                            std::size_t columns, int threads = 0);

/// For each column what is deepest of it: clear where nothing is seen of a value whatever its gradient.
[[nodiscard]] std::vector<OpticalEntry> deepest_entries(const RegionTable& table);

}  // namespace palpate
