#include "common/field/array_statistics.h"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <variant>

#include "common/base/index.h"
#include "common/base/parallel.h"
#include "common/field/grid/sparse/sparse_statistics.h"
#include "common/math/vec_text.h"

namespace palpate {
namespace {

/// Ranges of all components over fixed pieces of an array: minima, maxima and counts do not depend on how the
/// pieces are shared among threads.
struct PieceRange {
  std::vector<ComponentRange> ranges;
  std::uint64_t bad = 0;
};

void include_sparse(const SparseNumbers& numbers, int threads, ArrayStatistics& statistics) {
  if (statistics.ranges.empty()) statistics.ranges.assign(1, {HUGE_VAL, -HUGE_VAL});
  const SparseRange range = range_of(numbers, threads);
  statistics.bad_values += range.not_finite;
  statistics.ranges.front().lower = std::min(statistics.ranges.front().lower, range.lowest);
  statistics.ranges.front().upper = std::max(statistics.ranges.front().upper, range.highest);
}

/// Where a step of an image leads in RAS+ coordinates: "R" to the right, "L" to the left, "A" to the front, …
char letter_of(const Vec3& step) {
  constexpr std::string_view kUp = "RAS";
  constexpr std::string_view kDown = "LPI";
  int most = 0;
  for (int axis = 1; axis < 3; ++axis) {
    if (std::abs(step[axis]) > std::abs(step[most])) most = axis;
  }
  return (step[most] < 0.0 ? kDown : kUp)[as_size(most)];
}

}  // namespace

void include_array(const DataArray& array, int threads, ArrayStatistics& statistics) {
  if (array.sparse) return include_sparse(*array.sparse, threads, statistics);
  constexpr std::size_t kPiece = 65536;
  const std::size_t pieces = (array.tuples + kPiece - 1) / kPiece;
  const auto components = as_size(array.components);
  std::vector<PieceRange> found(pieces);
  parallel_for(pieces, threads, [&](std::size_t first, std::size_t last) {
    for (std::size_t p = first; p < last; ++p) {
      PieceRange& piece = found[p];
      piece.ranges.assign(components, {HUGE_VAL, -HUGE_VAL});
      for (std::size_t t = p * kPiece; t < std::min(array.tuples, (p + 1) * kPiece); ++t) {
        for (std::size_t c = 0; c < components; ++c) {
          const double value = array.at(t, static_cast<int>(c));
          if (!std::isfinite(value)) {
            ++piece.bad;
            continue;
          }
          piece.ranges[c].lower = std::min(piece.ranges[c].lower, value);
          piece.ranges[c].upper = std::max(piece.ranges[c].upper, value);
        }
      }
    }
  });
  if (statistics.ranges.empty()) statistics.ranges.assign(components, {HUGE_VAL, -HUGE_VAL});
  for (const PieceRange& piece : found) {
    statistics.bad_values += piece.bad;
    for (std::size_t c = 0; c < std::min(components, statistics.ranges.size()); ++c) {
      statistics.ranges[c].lower = std::min(statistics.ranges[c].lower, piece.ranges[c].lower);
      statistics.ranges[c].upper = std::max(statistics.ranges[c].upper, piece.ranges[c].upper);
    }
  }
}

std::string orientation_text(const DataSet& block, bool anatomical) {
  const auto* uniform = std::get_if<UniformTopology>(&block.topology);
  if (!uniform) return anatomical ? "RAS+ mm" : "coordinates as stored";
  const Mat3& a = uniform->axes;
  if (anatomical) {
    return std::string("RAS+ mm; voxel axes run to ") + letter_of(a[0]) + ", " + letter_of(a[1]) + ", " +
           letter_of(a[2]) + "; steps " + position_text(a[0]) + ", " + position_text(a[1]) + ", " +
           position_text(a[2]);
  }
  const bool aligned =
      a[0].y == 0.0 && a[0].z == 0.0 && a[1].x == 0.0 && a[1].z == 0.0 && a[2].x == 0.0 && a[2].y == 0.0;
  if (aligned) return "axes i, j, k along x, y, z; steps " + position_text({a[0].x, a[1].y, a[2].z});
  return "steps i " + position_text(a[0]) + ", j " + position_text(a[1]) + ", k " + position_text(a[2]);
}

}  // namespace palpate
