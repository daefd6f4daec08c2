/// Curved cells as linear ones: each is cut into n^3 parts, whose corners have the values of its polynomial.
///
/// One n holds for all cells, so that parts of neighbours share their corners: a multiple of the order, so large
/// that the parts are off by kCurvedError of the largest value, or as large as kMostParts allows.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/field/cells/coincident_points.h"
#include "common/field/data_set.h"

namespace palpate {

inline constexpr double kCurvedError = 1e-3;
/// Parts of all curved cells together; more where the order of the cells alone makes more.
inline constexpr std::size_t kMostParts = 120'000;

/// Points of a grid that are weighted sums of points of the data, those counted through all blocks.
struct MadePoints {
  std::vector<std::uint32_t> point;   ///< of the grid; kNoPoint where no cell uses it
  std::vector<std::size_t> begin{0};  ///< of each in the next two
  std::vector<std::uint32_t> input;
  std::vector<double> weight;
  /// By which linear interpolation between them is off, as a part of the largest value: 3/2 of the most that it is
  /// off in the middle of an edge, which bounds it for polynomials of order two; of up to 64 cells. Where the cell bends
  /// the middle of the part's edge is another place than the middle of the cell's, by a step along which its value changes.
  double error = 0.0;
};

struct CurvedSplit {
  std::vector<DataSet> blocks;  ///< without arrays; points of the data first, then those that were made
  std::vector<std::uint32_t> input_of;  ///< for each point of all blocks, that of the data, or kNoPoint
  std::vector<std::uint32_t> cell_of;   ///< for each cell of all blocks, that of the data
  MadePoints made;                      ///< in the order in which input_of has none; no `point` yet
  std::size_t cells = 0;                ///< that were curved
  int parts = 1;                        ///< n
  std::size_t unweighted = 0;           ///< Bezier cells without RationalWeights: those are 1
  std::size_t odd_weights = 0;          ///< Bezier cells of which one is not above 0: all are taken as 1
};

/// Nothing where no cell is curved. Cells of which no polynomial is known stay as they are.
[[nodiscard]] std::optional<CurvedSplit> split_curved(std::span<const DataSet> blocks,
                                                      const PointValue& value);

}  // namespace palpate
