/// Tetrahedral mesh in local frame L: adjacency, point location, linear interpolation.
///
/// Cell c has vertices v_0 … v_3, positively oriented: (x_1-x_0) x (x_2-x_0) . (x_3-x_0) > 0 except in
/// cells flagged as zero volume. Face i lies opposite vertex i; neighbors(c)[i] is the cell behind it, or
/// kNoCell on the border. With barycentric coordinates b_i the interpolant is f = sum_i b_i f_i.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "common/field/sample.h"
#include "common/math/vec.h"

namespace palpate {

using CellIndex = std::int32_t;
inline constexpr CellIndex kNoCell = -1;

/// A point of a tetrahedral mesh: its cell and barycentric coordinates there (sum 1).
struct TetPoint {
  CellIndex cell = kNoCell;
  Vec4 b{0.0};
};

class TetMesh {
 public:
  using Tet = std::array<std::uint32_t, 4>;
  using Neighbors = std::array<CellIndex, 4>;

  /// Orients the cells (inverted ones are turned and counted), finds neighbours, flags zero-volume cells
  /// (volume <= 2^-40 of the cube of the longest edge: below it barycentric coordinates have no correct
  /// digit in float32 data) and builds the index for point location.
  /// @throws Error (bad input, without file) on a vertex out of range, a face shared by three cells or
  /// more than 2^31 - 2 cells.
  TetMesh(std::vector<Vec3> points, std::vector<Tet> cells, int threads = 0);
  ~TetMesh();
  TetMesh(const TetMesh&) = delete;
  TetMesh& operator=(const TetMesh&) = delete;

  [[nodiscard]] std::span<const Vec3> points() const noexcept { return points_; }
  [[nodiscard]] std::span<const Tet> cells() const noexcept { return cells_; }
  [[nodiscard]] std::span<const Neighbors> neighbors() const noexcept { return neighbors_; }
  [[nodiscard]] bool zero_volume(CellIndex cell) const noexcept {
    return zero_volume_[static_cast<std::size_t>(cell)] != 0;
  }
  [[nodiscard]] std::size_t zero_volume_count() const noexcept { return zero_volume_count_; }
  [[nodiscard]] std::size_t inverted_count() const noexcept { return inverted_count_; }
  [[nodiscard]] const Box& bounds() const noexcept { return bounds_; }

  /// Finds the cell of `x`: a visibility walk from `hint`, else from the spatial index; falls back to the
  /// index's candidate cells where the walk leaves a non-convex mesh. A point on a face, edge or vertex
  /// always belongs to some cell. False outside and for NaN. Never returns a zero-volume cell.
  /// @rt Safe.
  [[nodiscard]] bool locate(const Vec3& x, CellIndex hint, TetPoint& found) const noexcept;

  /// Barycentric coordinates of `x` in `cell`. @pre not zero_volume(cell).
  [[nodiscard]] Vec4 barycentric(CellIndex cell, const Vec3& x) const noexcept;
  /// The point at barycentric coordinates `b` of `cell`.
  [[nodiscard]] Vec3 position(CellIndex cell, const Vec4& b) const noexcept;

 private:
  struct Index;
  std::vector<Vec3> points_;
  std::vector<Tet> cells_;
  std::vector<Neighbors> neighbors_;
  std::vector<std::uint8_t> zero_volume_;
  std::size_t zero_volume_count_ = 0;
  std::size_t inverted_count_ = 0;
  Box bounds_;
  std::unique_ptr<const Index> index_;
};

}  // namespace palpate
