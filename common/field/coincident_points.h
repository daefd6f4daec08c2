/// Points of the data at the same place: which are joined, and how far the values of the others jump.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "common/field/data_set.h"
#include "common/field/field_grid.h"
#include "common/field/grid/block_join.h"
#include "common/field/grid/tet_mesh.h"

namespace palpate {

/// The value at a point of a block, up to three numbers.
using PointValue = std::function<Vec3(const DataSet& block, std::size_t point)>;

/// As make_field_grid() without `value`. What the grid is made for is known here: points of one block are joined
/// too, wherever cells with points of their own meet; points stay apart where values differ (kSameValue). Where
/// `value` is empty all values agree.
[[nodiscard]] std::shared_ptr<const FieldGrid> make_field_grid(std::span<const DataSet> blocks,
                                                               const std::string& file, int threads,
                                                               const PointValue& value);

/// Values at one place are the same where they differ by no more than this part of the largest one there is at
/// such places: what single precision, and places equal to the last digit but one, leave of equal numbers.
inline constexpr double kSameValue = 1e-6;

class CoincidentPoints {
 public:
  /// @param value as in make_field_grid(); null where points of one block are not joined. Both outlive this.
  CoincidentPoints(std::span<const DataSet> blocks, const PointValue* value);

  /// Whether two points, counted through all blocks, are to be joined; empty where all are. Outlives not this.
  [[nodiscard]] PointsAgree agree() const;

  /// Looks for points of border faces of `mesh` that lie at the same place. For each point of the data the one
  /// that stands for it; empty where nothing is joined that was not.
  /// @param point_of_input see SplitMesh.
  [[nodiscard]] std::vector<std::uint32_t> first_of(const TetMesh& mesh,
                                                    std::span<const std::uint32_t> point_of_input);

  /// What was kept apart.
  void note(FieldNotes& notes) const;

 private:
  [[nodiscard]] Vec3 value(std::uint32_t input) const;
  [[nodiscard]] double jump(std::uint32_t a, std::uint32_t b) const;

  std::span<const DataSet> blocks_;
  const PointValue* value_;
  std::vector<std::size_t> first_point_;  ///< of each block, and their number
  double largest_ = 0.0;                  ///< value
  std::size_t apart_ = 0;
  double widest_ = 0.0;  ///< jump
};

}  // namespace palpate
