/// Values of cells at the boundary, where the data gives them: a solver's walls and inlets.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "common/field/data_set.h"
#include "common/field/field_grid.h"
#include "common/math/vec.h"

namespace palpate {

/// The name of the point array that says what the cell array `name` is at points of the boundary: NaN at points
/// where it says nothing. Loaders hand it over with the cell array; it is none to choose.
[[nodiscard]] std::string boundary_array_of(const std::string& name);

/// The name of the point array of six numbers that says across what the vectors of the cell array `name` do not go at
/// the boundary: the sum of n n^T over the faces around a point along which they slide (xx, xy, xz, yy, yz, zz; n the
/// normal), zero where there are none. As boundary_array_of(), whose vectors it holds for, too: what is given on both sides of
/// an edge may go through neither.
[[nodiscard]] std::string sliding_array_of(const std::string& name);

/// Values given at points of a grid of tetrahedra; the mean where several points of the data are joined.
class GivenValues {
 public:
  /// @param read of points of the blocks, NaN where nothing is given; empty where nothing is given at all.
  /// @param sliding the six numbers of sliding_array_of(), likewise; of vectors alone.
  GivenValues(const FieldGrid& grid, std::span<const DataSet> blocks, int components, const TupleReader& read,
              const TupleReader& sliding = {});

  /// Null where none is given.
  [[nodiscard]] const double* at(std::size_t point) const noexcept {
    return counts_.empty() || counts_[point] == 0 ? nullptr : values_.data() + point * components_;
  }
  /// Takes from a vector at a point what would go through a wall along which it slides.
  void slide(std::size_t point, double* value) const noexcept;
  /// Points that have one, and those that slide, in words; empty where none does.
  [[nodiscard]] std::string note() const;

 private:
  void take_means(const FieldGrid& grid, std::span<const DataSet> blocks, const TupleReader& read);

  std::size_t components_;
  std::vector<std::uint32_t> counts_;  ///< of values at each point; empty where there are none
  std::vector<double> values_;
  /// For each point, which of the next is its own; empty where none slides.
  std::vector<std::uint32_t> sliding_;
  std::vector<Mat3> along_;  ///< takes away what goes through; the first does not
  std::size_t slides_ = 0;   ///< points that have no given vector, and slide
  std::size_t edges_ = 0;    ///< points whose given vectors would go through a wall
};

/// As gather_values(); points whose values are given have these, whatever the cells say.
[[nodiscard]] GatheredValues gather_values(const FieldGrid& grid, std::span<const DataSet> blocks,
                                           Association association, int components, bool use_double,
                                           const TupleReader& read, CellRule rule, int threads,
                                           const GivenValues& given);

}  // namespace palpate
