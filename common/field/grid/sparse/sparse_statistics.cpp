#include "common/field/grid/sparse/sparse_statistics.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "common/base/check.h"
#include "common/base/index.h"
#include "common/base/parallel.h"

namespace palpate {
namespace {

// Calls f(number, points that have it) for all numbers of the layer `bz` of blocks.
template <typename F>
void visit_layer(const SparseNumbers& numbers, int bz, F f) {
  const Index3 blocks = numbers.blocks();
  for (int by = 0; by < blocks.y; ++by) {
    for (int bx = 0; bx < blocks.x; ++bx) {
      const Index3 b(bx, by, bz);
      const SparseBlock block = numbers.block(b);
      const PointBox points = numbers.points_of(b);
      if (block.numbers == nullptr) {
        f(block.constant, points.count());
        continue;
      }
      for (int x = points.first.x; x < points.end.x; ++x) {
        for (int y = points.first.y; y < points.end.y; ++y) {
          for (int z = points.first.z; z < points.end.z; ++z)
            f(block.at(Index3(x, y, z) + numbers.shift()), std::uint64_t{1});
        }
      }
    }
  }
}

// What add(part, number, count) gathers for each layer of blocks.
template <typename Part, typename Add>
std::vector<Part> gather_layers(const SparseNumbers& numbers, const Part& empty, int threads, Add add) {
  std::vector<Part> parts(as_size(numbers.blocks().z), empty);
  parallel_for(parts.size(), threads, [&](std::size_t first, std::size_t last) {
    for (std::size_t layer = first; layer < last; ++layer) {
      visit_layer(numbers, static_cast<int>(layer),
                  [&](float number, std::uint64_t count) { add(parts[layer], number, count); });
    }
  });
  return parts;
}

}  // namespace

SparseRange range_of(const SparseNumbers& numbers, int threads) {
  SparseRange all{HUGE_VAL, -HUGE_VAL, 0, false};
  const auto add = [](SparseRange& range, float number, std::uint64_t count) {
    const auto value = static_cast<double>(number);
    if (!std::isfinite(value)) {
      range.not_finite += count;
      range.has_infinite = range.has_infinite || std::isinf(value);
      return;
    }
    range.lowest = std::min(range.lowest, value);
    range.highest = std::max(range.highest, value);
  };
  for (const SparseRange& layer : gather_layers(numbers, all, threads, add)) {
    all.lowest = std::min(all.lowest, layer.lowest);
    all.highest = std::max(all.highest, layer.highest);
    all.not_finite += layer.not_finite;
    all.has_infinite = all.has_infinite || layer.has_infinite;
  }
  return all;
}

ValueHistogram count_values(const SparseNumbers& numbers, const std::function<double(double)>& value,
                            double lower, double upper, std::size_t bins, int threads) {
  const HistogramBins places(lower, upper, bins);
  const auto add = [&](std::vector<std::uint64_t>& counts, float number, std::uint64_t count) {
    if (const auto bin = places.of(value(static_cast<double>(number)))) counts[*bin] += count;
  };
  ValueHistogram histogram{.lower = lower, .upper = upper, .counts = std::vector<std::uint64_t>(bins, 0)};
  const std::vector<std::uint64_t> empty(bins, 0);
  for (const auto& layer : gather_layers(numbers, empty, threads, add)) {
    for (std::size_t bin = 0; bin < bins; ++bin) histogram.counts[bin] += layer[bin];
  }
  for (const std::uint64_t n : histogram.counts) histogram.total += n;
  return histogram;
}

}  // namespace palpate
