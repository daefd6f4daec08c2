/// Tetrahedral mesh in local frame L: adjacency, point location, linear interpolation.
///
/// Cell c has vertices v_0 … v_3, positively oriented: (x_1-x_0) x (x_2-x_0) . (x_3-x_0) > 0 except in
/// cells flagged as zero volume. Face i lies opposite vertex i; neighbors(c)[i] is the cell behind it, or
/// kNoCell on the border. With barycentric coordinates b_i the interpolant is f = sum_i b_i f_i.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "common/base/index.h"
#include "common/base/memory.h"
#include "common/field/grid/cell_tree.h"
#include "common/math/vec.h"

namespace palpate {

using CellIndex = std::int32_t;
inline constexpr CellIndex kNoCell = -1;

/// A point of a tetrahedral mesh: its cell and barycentric coordinates there (sum 1).
struct TetPoint {
  CellIndex cell = kNoCell;
  Vec4 b{0.0};
};

/// Corners of the face opposite each corner of a tetrahedron; counter-clockwise from outside where its volume
/// is positive.
inline constexpr std::array<std::array<std::size_t, 3>, 4> kTetFaces{
    {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};

class TetMesh {
 public:
  using Tet = std::array<std::uint32_t, 4>;
  using Neighbors = std::array<CellIndex, 4>;

  /// Orients the cells (inverted ones are turned and counted), puts them in an order that keeps neighbours
  /// close in memory (cell_order()), finds neighbours, flags zero-volume cells (least height <= 2^-40 of the
  /// longest edge: below it barycentric coordinates are rounding alone) and builds the index for point
  /// location. A face that more than two cells of some volume share is a
  /// border to all of them, and counted.
  /// @throws Error (bad input, without file) where there is no cell, on a vertex out of range or not finite,
  /// or on more than 2^31 - 2 cells.
  TetMesh(std::vector<Vec3> points, std::span<const Tet> cells, int threads = 0);

  [[nodiscard]] std::span<const Vec3> points() const noexcept { return points_; }
  /// Points that are corners of some cell.
  [[nodiscard]] std::size_t used_point_count() const noexcept { return used_point_count_; }
  [[nodiscard]] std::span<const Tet> cells() const noexcept { return cells_; }
  [[nodiscard]] std::span<const Neighbors> neighbors() const noexcept { return neighbors_; }
  [[nodiscard]] bool zero_volume(CellIndex cell) const noexcept { return zero_volume_[as_size(cell)] != 0; }
  [[nodiscard]] std::size_t zero_volume_count() const noexcept { return zero_volume_count_; }
  [[nodiscard]] std::size_t inverted_count() const noexcept { return inverted_count_; }
  /// Faces with cells that lie over one another on a side: each cell has at most one neighbour there, the others none.
  [[nodiscard]] std::size_t overlapping_face_count() const noexcept { return overlapping_face_count_; }
  /// Makes a wall of a face: nothing is behind it, though cells may lie there. Location does not heed walls.
  void close(CellIndex cell, int face);
  [[nodiscard]] bool closed(CellIndex cell, int face) const noexcept {
    return !walls_.empty() && ((walls_[as_size(cell)] >> static_cast<unsigned>(face)) & 1U) != 0;
  }
  /// The place that each cell had among the cells given to the constructor.
  [[nodiscard]] std::span<const std::uint32_t> cell_order() const noexcept { return cell_order_; }
  /// Bounds of the cells.
  [[nodiscard]] const Box& bounds() const noexcept { return bounds_; }

  /// Finds the cell of `x`: a visibility walk from `hint`, else from a cell that the index names; where the
  /// walk leaves a non-convex mesh, meets a zero-volume cell or runs past its bound, every cell of the index
  /// that may hold `x` is asked. A point on a face, edge or vertex always belongs to some cell, and so do
  /// points less than rounding (2^-50 of the largest coordinate) outside. False outside and for NaN.
  /// Never returns a zero-volume cell. Where cells overlap: rank_cells(). @rt Safe.
  [[nodiscard]] bool locate(const Vec3& x, CellIndex hint, TetPoint& found) const noexcept;

  /// Says which cell counts where several hold a point: the one of the lowest rank.
  /// @param contested a byte for each cell, not 0 where cells of a lower rank may hold points of it.
  void rank_cells(std::vector<std::uint32_t> rank, std::vector<std::uint8_t> contested);
  /// Calls `visit(first, last)` for runs of cells among which are all that meet a box, until it returns true. @rt Safe.
  template <typename Visit>
  void visit_cells(const Box& box, Visit&& visit) const noexcept {
    tree_.visit_leaves(box.lower, box.upper, visit);
  }

  /// Barycentric coordinates of `x` in `cell`. @pre not zero_volume(cell).
  [[nodiscard]] Vec4 barycentric(CellIndex cell, const Vec3& x) const noexcept;
  /// Gradients of the barycentric coordinates 1, 2 and 3 (that of 0 is minus their sum), as columns.
  /// @pre not zero_volume(cell).
  [[nodiscard]] Mat3 barycentric_gradients(CellIndex cell) const noexcept;
  /// The point at barycentric coordinates `b` of `cell`.
  [[nodiscard]] Vec3 position(CellIndex cell, const Vec4& b) const noexcept;

 private:
  /// What a walk needs of a cell, side by side: its corners and what lies behind its faces. One cache line
  /// where the coordinates are single-precision numbers, as they are in most files; else two.
  template <typename T>
  struct alignas(16 * sizeof(T)) Step {
    std::array<std::array<T, 3>, 4> x;
    Neighbors behind;
  };

  /// From `start`, unless a barycentric coordinate there is below -farthest.
  [[nodiscard]] bool walk(const Vec3& x, CellIndex start, double farthest, TetPoint& found) const noexcept;
  template <typename T>
  [[nodiscard]] bool walk_over(const LargeVector<Step<T>>& steps, const Vec3& x, CellIndex start,
                               double farthest, TetPoint& found) const noexcept;
  template <typename T>
  void fill_steps(LargeVector<Step<T>>& steps, int threads);
  [[nodiscard]] bool search(const Vec3& x, TetPoint& found) const noexcept;
  void take_first_rank(const Vec3& x, TetPoint& found) const noexcept;
  /// @return which cells were turned.
  [[nodiscard]] std::vector<std::uint8_t> orient_cells(int threads);
  void find_neighbors(const std::vector<std::uint8_t>& turned, int threads);
  /// Whether two cells lie on the same side of a face that they share, as doubled cells do: no neighbours. A cell that was turned
  /// folds over its neighbour, and is left as one: its file has them on different sides.
  [[nodiscard]] bool lies_over(std::uint32_t a, std::uint32_t b, const std::array<std::uint32_t, 3>& face,
                               const std::vector<std::uint8_t>& turned) const;

  std::vector<Vec3> points_;
  LargeVector<Tet> cells_;
  LargeVector<Neighbors> neighbors_;
  LargeVector<Step<float>> single_steps_;   ///< filled if every coordinate is a single-precision number
  LargeVector<Step<double>> double_steps_;  ///< filled otherwise
  std::vector<std::uint8_t> zero_volume_;
  std::vector<std::uint32_t> cell_order_;
  std::size_t used_point_count_ = 0;
  std::size_t zero_volume_count_ = 0;
  std::size_t inverted_count_ = 0;
  std::size_t overlapping_face_count_ = 0;
  Box bounds_;
  double slack_ = 0.0;  ///< distance that rounding moves a point [frame L]
  CellTree tree_;
  std::vector<std::uint32_t> rank_;      ///< of each cell; empty where all count alike
  std::vector<std::uint8_t> contested_;  ///< as rank_cells() has it
  std::vector<std::uint8_t> walls_;      ///< a bit for each face that is closed; empty where none is
};

}  // namespace palpate
