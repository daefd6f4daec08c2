/// Ranges and histograms of sparse numbers: those of parts with one number are counted at once.
#pragma once

#include <cstdint>
#include <functional>

#include "common/field/grid/sparse/sparse_numbers.h"
#include "common/field/value_histogram.h"

namespace palpate {

struct SparseRange {
  double lowest = 0.0;  ///< of the finite numbers; lowest > highest where there are none
  double highest = -1.0;
  std::uint64_t not_finite = 0;  ///< NaN and infinite ones
  bool has_infinite = false;
};

/// The numbers of the points of the box. The result does not depend on the number of threads (0: as many as
/// there are cores).
[[nodiscard]] SparseRange range_of(const SparseNumbers& numbers, int threads);

/// As count_values() of value_histogram.h, of value(number) of all points.
[[nodiscard]] ValueHistogram count_values(const SparseNumbers& numbers,
                                          const std::function<double(double)>& value, double lower,
                                          double upper, std::size_t bins, int threads);

}  // namespace palpate
