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

/// The value at a point of a block, up to three numbers; or of a cell.
using PointValue = std::function<Vec3(const DataSet& block, std::size_t point)>;

/// The values that a grid is made for.
struct GridValue {
  Association association = Association::kPoint;
  PointValue of;
  bool velocity = true;  ///< that tells thin walls from seams; else nothing is taken for a wall
};

/// As make_field_grid() without `value`. What the grid is made for is known here: points of one block are joined
/// too, wherever cells with points of their own meet, but not at thin walls (thin_walls.h); points stay apart
/// where values differ (kSameValue). Where values are those of cells all agree.
[[nodiscard]] std::shared_ptr<const FieldGrid> make_field_grid(std::span<const DataSet> blocks,
                                                               const std::string& file, int threads,
                                                               const GridValue& value);

/// Values at one place are the same where they differ by no more than this part of the largest one there is at
/// such places: what single precision, and places equal to the last digit but one, leave of equal numbers.
inline constexpr double kSameValue = 1e-6;

/// Points of the data whose values differ (kSameValue) from those of the points that stand for them.
struct LostValues {
  std::size_t points = 0;
  double most = 0.0;  ///< by which they differ
};
[[nodiscard]] LostValues find_lost_values(const FieldGrid& grid, std::span<const DataSet> blocks,
                                          const PointValue& value);

class CoincidentPoints {
 public:
  /// @param value of points; empty where all agree. Both outlive this.
  CoincidentPoints(std::span<const DataSet> blocks, const PointValue& value);

  /// Whether two points, counted through all blocks, are to be joined; empty where all are. Outlives not this.
  [[nodiscard]] PointsAgree agree() const;

  /// Looks for points of border faces of `mesh` that lie at the same place.
  /// @param point_of_input see SplitMesh.
  void find(const TetMesh& mesh, std::span<const std::uint32_t> point_of_input);
  /// For each point of the mesh the first one at its place.
  [[nodiscard]] std::span<const std::uint32_t> place() const noexcept { return place_; }
  /// Of a point of the mesh. @pre values of points.
  [[nodiscard]] Vec3 value_at(std::uint32_t point) const { return value(input_of_[point]); }
  /// Of a point of the data, counted through all blocks. @pre values of points.
  [[nodiscard]] Vec3 value(std::uint32_t input) const;

  /// For each point of the data the one that stands for it; empty where nothing is joined that was not.
  /// @param apart for each point of the mesh whether it is not joined within its block; empty where all are.
  [[nodiscard]] std::vector<std::uint32_t> first_of(const TetMesh& mesh,
                                                    std::span<const std::uint32_t> point_of_input,
                                                    std::span<const std::uint8_t> apart);

  /// What was kept apart.
  void note(FieldNotes& notes) const;

 private:
  [[nodiscard]] std::size_t block_of(std::uint32_t input) const;
  [[nodiscard]] bool distinguishable() const noexcept { return static_cast<bool>(value_); }
  [[nodiscard]] double jump(std::uint32_t a, std::uint32_t b) const;

  std::span<const DataSet> blocks_;
  const PointValue& value_;
  std::vector<std::size_t> first_point_;  ///< of each block, and their number
  std::vector<MergeCandidate> candidates_;
  std::vector<std::uint32_t> place_;
  std::vector<std::uint32_t> input_of_;  ///< for each point of the mesh the first of the data's
  double largest_ = 0.0;                 ///< value
  std::size_t apart_ = 0;
  double widest_ = 0.0;  ///< jump
};

}  // namespace palpate
