#include "common/render/volume/voxels/region_table.h"

#include <algorithm>

#include "common/base/check.h"
#include "common/base/parallel.h"

namespace palpate {

RegionTable make_region_table(const RegionTransfer& transfer, const PlaceRange& range, std::size_t columns,
                              int threads) {
  PALPATE_CHECK(columns >= 2);
  RegionTable table{columns, kGradientEntries, {}};
  table.entries.resize(table.columns * table.rows);
  parallel_for(table.rows, threads, [&](std::size_t first, std::size_t last) {
    for (std::size_t row = first; row < last; ++row) {
      for (std::size_t column = 0; column < table.columns; ++column) {
        const Vec2 part(static_cast<double>(column) / static_cast<double>(table.columns - 1),
                        static_cast<double>(row) / static_cast<double>(table.rows - 1));
        const RegionTransfer::Sample sample = transfer.at((1.0 - part) * range.lower + part * range.upper);
        const auto depth = static_cast<float>(sample.depth);
        const Vec3f color = depth * sample.color;
        table.entries[column + table.columns * row] = {color.r, color.g, color.b, depth};
      }
    }
  });
  return table;
}

std::vector<OpticalEntry> deepest_entries(const RegionTable& table) {
  std::vector<OpticalEntry> deepest(table.columns);
  for (std::size_t row = 0; row < table.rows; ++row) {
    for (std::size_t column = 0; column < table.columns; ++column) {
      float& depth = deepest[column].depth;
      depth = std::max(depth, table.entries[column + table.columns * row][3]);
    }
  }
  return deepest;
}

}  // namespace palpate
