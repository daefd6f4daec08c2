/// The grid of a data set in local frame L, made once and shared by every field on it, with the way from
/// the data's points and cells to its own.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "common/field/data_set.h"
#include "common/field/grid/box_grid.h"
#include "common/field/grid/tet_mesh.h"
#include "common/field/local_frame.h"
#include "common/field/vector_field.h"

namespace palpate {

struct MadePoints;  // curved_split.h

/// Exactly one of `box` and `tets` is not null.
struct FieldGrid {
  LocalFrame frame;  ///< lengths and axes; its speed exponent is zero
  Box bounds;        ///< data coordinates
  std::shared_ptr<const BoxGrid> box;
  std::shared_ptr<const TetMesh> tets;
  std::array<bool, 3> reversed{};             ///< box: the data's points run backwards along the axis
  bool blanked = false;                       ///< box: some points are blanked
  std::vector<std::uint32_t> point_of_input;  ///< tets: see SplitMesh; empty where every point is its own
  std::vector<std::uint32_t> source_cell;     ///< tets: for each, its cell in the data
  std::size_t input_points = 0;               ///< of all blocks
  std::size_t input_cells = 0;
  FieldNotes notes;
  std::shared_ptr<const MadePoints> made;  ///< tets: points inside curved cells; null where there are none
  double point_rounding = 0.0;  ///< by how much points may lie elsewhere, in data units: value_rounding.h

  [[nodiscard]] std::size_t point_count() const noexcept;
  /// Index of the data's tuple at `at` of a box grid with `n` tuples along the axes.
  [[nodiscard]] std::size_t data_index(const Index3& n, Index3 at) const;
  /// The grid's points are the data's points, one for one.
  [[nodiscard]] bool same_points() const noexcept {
    return !reversed[0] && !reversed[1] && !reversed[2] && !blanked && point_of_input.empty() && !made;
  }
};

/// How a box grid, whose coordinates rise, takes axes of the data that fall or that are left-handed.
enum class FallingAxes {
  kReversed,  ///< points in another order than the data's
  /// The data's order of points, in a frame that is mirrored where need be: values of scalars stay where they lie. Of a
  /// uniform block alone.
  kMirrored,
};

/// One uniform or rectilinear block becomes a box grid, a sheared one, too; everything else is split into tetrahedra.
/// @throws Error (bad input) with `file` for hostile or flat topologies.
[[nodiscard]] std::shared_ptr<const FieldGrid> make_field_grid(std::span<const DataSet> blocks,
                                                               const std::string& file, int threads,
                                                               FallingAxes falling = FallingAxes::kReversed);

/// How cell values come to the points. Tensors and outer products take the mean: it is positive where they are.
enum class CellRule {
  kLeastSquares,  ///< cell_fit.h
  kMean,          ///< volume-weighted, of the cells that touch the point
};

/// By how much the mean over each cell of a field made of cell values differs from the cell's value.
struct CellDifference {
  double largest = 0.0;  ///< as a part of the largest value, as is the next
  double rms = 0.0;
  std::size_t flat = 0;  ///< points about which the cells lie in one layer: nothing is known across it
};

/// Values at the grid's points, brought there from the data's points or cells.
struct GatheredValues {
  std::vector<float> floats;  ///< filled unless `use_double`
  std::vector<double> doubles;
  CellDifference cells;  ///< of values of cells
};

/// Reads `components` numbers of a tuple of a block into `out`.
using TupleReader = std::function<void(const DataSet& block, std::size_t tuple, double* out)>;

/// Brings values to the grid's points: those of joined points from the first of them, those of cells by
/// `rule` from the cells around each point (cell_values.h), those inside curved cells by their polynomials, NaN at
/// blanked points of a box grid. Points that no value reaches are NaN. @pre `blocks` are those that the grid was made of.
[[nodiscard]] GatheredValues gather_values(const FieldGrid& grid, std::span<const DataSet> blocks,
                                           Association association, int components, bool use_double,
                                           const TupleReader& read, CellRule rule, int threads);

}  // namespace palpate
