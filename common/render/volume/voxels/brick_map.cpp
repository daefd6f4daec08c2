#include "common/render/volume/voxels/brick_map.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <type_traits>
#include <vector>

#include "common/base/check.h"
#include "common/base/index.h"
#include "common/base/parallel.h"
#include "common/base/read_as.h"
#include "common/render/volume/voxels/sign_bit.h"

namespace palpate {
namespace {

constexpr std::uint8_t kFarthest = 255;

std::uint8_t one_more(std::uint8_t distance) {
  return distance < kFarthest ? static_cast<std::uint8_t>(distance + 1) : kFarthest;
}

// One sweep of the distance by the largest axis, exact with a second one from the other end (Rosenfeld and
// Pfaltz 1968): each brick is at most one further than those of the 26 around it that came before.
// @param reversed from the last brick to the first
void sweep(std::vector<std::uint8_t>& distances, const Index3& bricks, bool reversed) {
  const std::size_t width = as_size(bricks.x);
  // Least of the rows before, with a brick that is never nearest at each end.
  std::vector<std::uint8_t> before(width + 2);
  for (int k = 0; k < bricks.z; ++k) {
    for (int j = 0; j < bricks.y; ++j) {
      const int back = reversed ? 1 : -1;
      const int y = reversed ? bricks.y - 1 - j : j, z = reversed ? bricks.z - 1 - k : k;
      const auto row_at = [&](int row_y, int row_z) {
        return distances.data() + width * (as_size(row_y) + as_size(bricks.y) * as_size(row_z));
      };
      std::fill(before.begin(), before.end(), kFarthest);
      const auto take = [&](int row_y, int row_z) {
        if (row_y < 0 || row_y >= bricks.y || row_z < 0 || row_z >= bricks.z) return;
        const std::uint8_t* row = row_at(row_y, row_z);
        for (std::size_t x = 0; x < width; ++x) before[x + 1] = std::min(before[x + 1], row[x]);
      };
      take(y + back, z);
      for (int side = -1; side <= 1; ++side) take(y + side, z + back);
      std::uint8_t* row = row_at(y, z);
      for (std::size_t x = 0; x < width; ++x) {
        row[x] = std::min(row[x], one_more(std::min({before[x], before[x + 1], before[x + 2]})));
      }
      for (std::size_t i = 1; i < width; ++i) {
        const std::size_t x = reversed ? width - 1 - i : i;
        row[x] = std::min(row[x], one_more(row[reversed ? x + 1 : x - 1]));
      }
    }
  }
}

// From seen bricks, at 0, to all others.
void find_distances(std::vector<std::uint8_t>& distances, const Index3& bricks) {
  sweep(distances, bricks, false);
  sweep(distances, bricks, true);
}

// Which of `count` equally spaced entries lie next to a number.
struct EntryScale {
  // The texture unit's rounding may reach a little further than the values do.
  static constexpr double kRounding = 1e-3;
  double lower = 0.0, upper = 1.0;
  std::size_t count = 2;

  [[nodiscard]] std::size_t below(double number) const {
    return bounded(std::floor(place(number) - kRounding));
  }
  [[nodiscard]] std::size_t above(double number) const {
    return bounded(std::ceil(place(number) + kRounding));
  }

 private:
  [[nodiscard]] double last() const { return static_cast<double>(count - 1); }
  [[nodiscard]] double place(double number) const { return last() * ((number - lower) / (upper - lower)); }
  [[nodiscard]] std::size_t bounded(double entry) const {
    return static_cast<std::size_t>(std::clamp(entry, 0.0, last()));
  }
};

}  // namespace

namespace {

// The ranges of the row of bricks at (by, bz): where no leaf is met, those of a few numbers.
void find_sparse_row(const SparseNumbers& numbers, int by, int bz, std::span<BrickRanges::Range> row) {
  const Index3 n = numbers.points(), shift = numbers.shift();
  const auto block_of = [](int voxel) { return voxel / kBlockSide; };
  SparseReader reader(numbers);
  for (std::size_t i = 0; i < row.size(); ++i) {
    const Index3 first(kBrickCells * static_cast<int>(i), kBrickCells * by, kBrickCells * bz);
    const Index3 end = glm::min(first + kBrickCells + 1, n);
    float lowest = HUGE_VALF, highest = -HUGE_VALF;
    const auto include = [&](float v) {
      lowest = v < lowest ? v : lowest;  // NaN passes both
      highest = v > highest ? v : highest;
    };
    bool leaf = false;
    for (int z = block_of(first.z + shift.z); z <= block_of(end.z - 1 + shift.z); ++z) {
      for (int y = block_of(first.y + shift.y); y <= block_of(end.y - 1 + shift.y); ++y) {
        for (int x = block_of(first.x + shift.x); x <= block_of(end.x - 1 + shift.x) && !leaf; ++x) {
          const SparseBlock block = numbers.block({x, y, z});
          leaf = block.numbers != nullptr;
          if (!leaf) include(block.constant);
        }
      }
    }
    if (leaf) {
      lowest = HUGE_VALF;
      highest = -HUGE_VALF;
      for (int x = first.x; x < end.x; ++x) {
        for (int y = first.y; y < end.y; ++y) {
          for (int z = first.z; z < end.z; ++z) include(reader.at({x, y, z}));
        }
      }
    }
    row[i] = {lowest, highest};
  }
}

// The same of numbers that stand one after another. A brick's last points are the first ones of the next: cells, not
// points, are cut apart.
template <typename T>
void find_row(const VolumeImage& image, int by, int bz, std::span<BrickRanges::Range> row) {
  const Index3 n = image.points;
  const int y1 = std::min(n.y, kBrickCells * (by + 1) + 1), z1 = std::min(n.z, kBrickCells * (bz + 1) + 1);
  using Limits = std::numeric_limits<T>;
  constexpr T kMost = Limits::has_infinity ? Limits::infinity() : Limits::max(),
              kLeast = Limits::has_infinity ? -Limits::infinity() : Limits::lowest();
  std::vector<T> lowest(as_size(n.x), kMost), highest(as_size(n.x), kLeast);  // along y and z
  for (int z = kBrickCells * bz; z < z1; ++z) {
    for (int y = kBrickCells * by; y < y1; ++y) {
      const std::size_t start = as_size(n.x) * (as_size(y) + as_size(n.y) * as_size(z));
      for (std::size_t x = 0; x < lowest.size(); ++x) {
        T v = read_as<T>(image.bytes, start + x);
        if constexpr (std::is_integral_v<T>) v = static_cast<T>(v ^ sign_bit<T>(image));
        lowest[x] = v < lowest[x] ? v : lowest[x];  // NaN passes both
        highest[x] = v > highest[x] ? v : highest[x];
      }
    }
  }
  for (std::size_t bx = 0; bx < row.size(); ++bx) {
    const std::size_t x0 = bx * kBrickCells, x1 = std::min(as_size(n.x), x0 + kBrickCells + 1);
    const auto at = [](const std::vector<T>& v, std::size_t x) {
      return v.begin() + static_cast<std::ptrdiff_t>(x);
    };
    row[bx] = {static_cast<float>(*std::min_element(at(lowest, x0), at(lowest, x1))),
               static_cast<float>(*std::max_element(at(highest, x0), at(highest, x1)))};
  }
}

}  // namespace

BrickRanges brick_ranges(const VolumeImage& image, int threads) {
  BrickRanges result;
  for (int a = 0; a < 3; ++a) {
    result.bricks[a] = std::max(1, (image.points[a] - 1 + kBrickCells - 1) / kBrickCells);
  }
  const Index3 b = result.bricks;
  result.ranges.resize(as_size(b.x) * as_size(b.y) * as_size(b.z));
  parallel_for(as_size(b.y) * as_size(b.z), threads, [&](std::size_t first, std::size_t last) {
    for (std::size_t row = first; row < last; ++row) {
      const int by = static_cast<int>(row % as_size(b.y)), bz = static_cast<int>(row / as_size(b.y));
      if (image.sparse) {
        find_sparse_row(*image.sparse, by, bz,
                        std::span(result.ranges).subspan(as_size(b.x) * row, as_size(b.x)));
        continue;
      }
      const std::span<BrickRanges::Range> to =
          std::span(result.ranges).subspan(as_size(b.x) * row, as_size(b.x));
      if (image.type == ScalarType::kUint8) {
        find_row<std::uint8_t>(image, by, bz, to);
      } else if (image.type == ScalarType::kUint16) {
        find_row<std::uint16_t>(image, by, bz, to);
      } else {
        find_row<float>(image, by, bz, to);
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
  const EntryScale columns{lower, upper, entries.size()};
  std::vector<std::uint8_t> distances(ranges.ranges.size());
  for (std::size_t i = 0; i < distances.size(); ++i) {
    const BrickRanges::Range& range = ranges.ranges[i];
    bool empty = range.highest < range.lowest;
    if (!empty) empty = seen[columns.above(range.highest) + 1] == seen[columns.below(range.lowest)];
    distances[i] = empty ? kFarthest : 0;
  }
  find_distances(distances, ranges.bricks);
  return distances;
}

std::vector<std::uint8_t> empty_distances(const BrickRanges& ranges, const GradientRanges& gradients,
                                          const RegionTable& table, double lower, double upper,
                                          double highest) {
  PALPATE_CHECK(gradients.ranges.size() == ranges.ranges.size() && lower < upper && highest > 0.0);
  // How many entries before each one, along both, are not clear.
  const std::size_t width = table.columns + 1;
  std::vector<std::uint32_t> seen(width * (table.rows + 1), 0);
  for (std::size_t row = 0; row < table.rows; ++row) {
    std::uint32_t in_row = 0;
    for (std::size_t column = 0; column < table.columns; ++column) {
      in_row += table.clear(column, row) ? 0 : 1;
      seen[column + 1 + width * (row + 1)] = seen[column + 1 + width * row] + in_row;
    }
  }
  const EntryScale columns{lower, upper, table.columns}, rows{0.0, highest, table.rows};
  std::vector<std::uint8_t> distances(ranges.ranges.size());
  for (std::size_t i = 0; i < distances.size(); ++i) {
    const BrickRanges::Range& values = ranges.ranges[i];
    const GradientRanges::Range& slopes = gradients.ranges[i];
    bool empty = values.highest < values.lowest || slopes.highest < slopes.lowest;
    if (!empty) {
      const std::size_t left = columns.below(values.lowest), right = columns.above(values.highest) + 1;
      const std::size_t low = width * rows.below(slopes.lowest),
                        high = width * (rows.above(slopes.highest) + 1);
      empty = seen[right + high] + seen[left + low] == seen[left + high] + seen[right + low];
    }
    distances[i] = empty ? kFarthest : 0;
  }
  find_distances(distances, ranges.bricks);
  return distances;
}

double gap_share(const Index3& bricks, std::span<const std::uint8_t> distances) {
  const std::size_t row = as_size(bricks.x), count = row * as_size(bricks.y) * as_size(bricks.z);
  PALPATE_CHECK(count > 0 && distances.size() % count == 0);
  std::size_t gaps = 0, all = 0;
  for (std::size_t first = 0; first < count; first += row) {
    std::size_t since = 0;  // empty ones since the last one that is not
    bool inside = false;
    for (std::size_t i = first; i < first + row; ++i) {
      bool shows = false;
      for (std::size_t map = i; map < distances.size(); map += count) shows = shows || distances[map] == 0;
      if (shows) {
        gaps += inside ? since : 0;
        all += inside ? since + 1 : 1;
        since = 0;
        inside = true;
      } else {
        ++since;
      }
    }
  }
  return all > 0 ? static_cast<double>(gaps) / static_cast<double>(all) : 0.0;
}

}  // namespace palpate
