/// How long the lines of a tractogram are.
#pragma once

#include <array>
#include <cstddef>

#include "common/geometry/tractogram.h"
#include "common/math/vec.h"

namespace palpate {

/// Lengths along the lines [mm]; zeros where there is no line.
struct TractogramLengths {
  static constexpr std::size_t kBins = 8;
  double least = 0.0, median = 0.0, mean = 0.0, most = 0.0;
  double bin = 0.0;                            ///< width of a bin: `most` / kBins
  std::array<std::size_t, kBins> histogram{};  ///< from 0 to `most`
  Box bounds;                                  ///< of all points
};

[[nodiscard]] TractogramLengths lengths_of(const Tractogram& lines);

}  // namespace palpate
