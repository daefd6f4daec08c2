#include "common/render/volume/brick_map.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "common/base/check.h"
#include "common/base/parallel.h"

namespace palpate {
namespace {

constexpr std::uint8_t kFarthest = 255;

std::size_t size_of(int n) { return static_cast<std::size_t>(n); }

// For each of `count` numbers `stride` apart, the least of those at distance r plus r: one axis of a distance
// by the largest axis needs the maximum of both instead.
void spread_along(std::uint8_t* line, int count, std::size_t stride, std::vector<std::uint8_t>& scratch) {
  scratch.resize(size_of(count));
  for (int i = 0; i < count; ++i) scratch[size_of(i)] = line[stride * size_of(i)];
  for (int i = 0; i < count; ++i) {
    int least = scratch[size_of(i)];
    // max(r, value at distance r) can only be less than `least` while r is.
    for (int r = 1; r < least; ++r) {
      if (i - r >= 0) least = std::min(least, std::max<int>(r, scratch[size_of(i - r)]));
      if (i + r < count) least = std::min(least, std::max<int>(r, scratch[size_of(i + r)]));
      if (i - r < 0 && i + r >= count) break;
    }
    line[stride * size_of(i)] = static_cast<std::uint8_t>(least);
  }
}

}  // namespace

BrickRanges brick_ranges(const VolumeImage& image, int threads) {
  BrickRanges result;
  for (int a = 0; a < 3; ++a) {
    result.bricks[a] = std::max(1, (image.points[a] - 1 + kBrickCells - 1) / kBrickCells);
  }
  const Index3 n = image.points, b = result.bricks;
  result.ranges.resize(size_of(b.x) * size_of(b.y) * size_of(b.z));
  parallel_for(size_of(b.y) * size_of(b.z), threads, [&](std::size_t first, std::size_t last) {
    for (std::size_t row = first; row < last; ++row) {
      const int by = static_cast<int>(row % size_of(b.y)), bz = static_cast<int>(row / size_of(b.y));
      // A brick's last points are the first ones of the next: cells, not points, are cut apart.
      const int y1 = std::min(n.y, kBrickCells * (by + 1) + 1),
                z1 = std::min(n.z, kBrickCells * (bz + 1) + 1);
      for (int bx = 0; bx < b.x; ++bx) {
        const int x1 = std::min(n.x, kBrickCells * (bx + 1) + 1);
        float lowest = HUGE_VALF, highest = -HUGE_VALF;
        for (int z = kBrickCells * bz; z < z1; ++z) {
          for (int y = kBrickCells * by; y < y1; ++y) {
            const std::size_t start = size_of(n.x) * (size_of(y) + size_of(n.y) * size_of(z));
            for (int x = kBrickCells * bx; x < x1; ++x) {
              const auto v = static_cast<float>(image.number(start + size_of(x)));
              lowest = v < lowest ? v : lowest;  // NaN passes both
              highest = v > highest ? v : highest;
            }
          }
        }
        result.ranges[size_of(bx) + size_of(b.x) * row] = {lowest, highest};
      }
    }
  });
  return result;
}

std::vector<std::uint8_t> empty_distances(const BrickRanges& ranges, std::span<const OpticalEntry> entries,
                                          double lower, double upper) {
  PALPATE_CHECK(entries.size() >= 2 && lower < upper);
  // How many entries before each one are not clear.
  std::vector<std::size_t> seen(entries.size() + 1, 0);
  for (std::size_t i = 0; i < entries.size(); ++i) seen[i + 1] = seen[i] + (entries[i].depth > 0.0F ? 1 : 0);
  const double last = static_cast<double>(entries.size() - 1);
  const auto place = [&](float number) {
    return last * ((static_cast<double>(number) - lower) / (upper - lower));
  };
  // The texture unit's rounding may reach a little further than the values do.
  constexpr double kRounding = 1e-3;
  std::vector<std::uint8_t> distances(ranges.ranges.size());
  for (std::size_t i = 0; i < distances.size(); ++i) {
    const BrickRanges::Range& range = ranges.ranges[i];
    bool empty = range.highest < range.lowest;
    if (!empty) {
      const auto from =
          static_cast<std::size_t>(std::clamp(std::floor(place(range.lowest) - kRounding), 0.0, last));
      const auto to =
          static_cast<std::size_t>(std::clamp(std::ceil(place(range.highest) + kRounding), 0.0, last));
      empty = seen[to + 1] == seen[from];
    }
    distances[i] = empty ? kFarthest : 0;
  }

  const Index3 b = ranges.bricks;
  std::vector<std::uint8_t> scratch;
  for (int z = 0; z < b.z; ++z) {
    for (int y = 0; y < b.y; ++y) {
      spread_along(distances.data() + size_of(b.x) * (size_of(y) + size_of(b.y) * size_of(z)), b.x, 1,
                   scratch);
    }
  }
  for (int z = 0; z < b.z; ++z) {
    for (int x = 0; x < b.x; ++x) {
      spread_along(distances.data() + size_of(x) + size_of(b.x) * size_of(b.y) * size_of(z), b.y,
                   size_of(b.x), scratch);
    }
  }
  for (int y = 0; y < b.y; ++y) {
    for (int x = 0; x < b.x; ++x) {
      spread_along(distances.data() + size_of(x) + size_of(b.x) * size_of(y), b.z,
                   size_of(b.x) * size_of(b.y), scratch);
    }
  }
  return distances;
}

}  // namespace palpate
