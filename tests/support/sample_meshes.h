/// Data sets of awkward shapes for tests: mixed cells that share faces, seams, blocks in any orientation.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <random>
#include <vector>

#include "common/field/data_set.h"

namespace palpate::test {

/// Collects cells over shared points; points are numbered in a random order when taken out.
class CellSoup {
 public:
  std::uint32_t add_point(const Vec3& x) {
    points_.push_back(x);
    return static_cast<std::uint32_t>(points_.size() - 1);
  }
  void add_cell(std::uint8_t type, const std::vector<std::int64_t>& points) {
    cells_.push_back({type, points});
  }
  /// A polyhedron by its faces, each turned at random.
  void add_polyhedron(const std::vector<std::vector<std::int64_t>>& faces, std::mt19937_64& random);

  [[nodiscard]] const std::vector<Vec3>& points() const { return points_; }
  /// The data set with points and cells in random order, and the array "velocity" from `value`.
  [[nodiscard]] DataSet take(std::mt19937_64& random, const std::function<Vec3(const Vec3&)>& value) const;

 private:
  struct Cell {
    std::uint8_t type;
    std::vector<std::int64_t> stream;
  };
  std::vector<Vec3> points_;
  std::vector<Cell> cells_;
};

/// n^3 cubes in [0, 1]^3, inner points moved by up to `jitter` of a cube, each made at random a hexahedron
/// (in any of its 24 vertex orders), six pyramids or a polyhedron; whole columns along z two wedges. Without
/// jitter also pairs of cubes as one polyhedron of ten faces, some of them coplanar.
[[nodiscard]] DataSet mixed_cells(int n, double jitter, std::uint64_t seed,
                                  const std::function<Vec3(const Vec3&)>& value);

/// Prisms over a honeycomb of hexagons and the pentagons and wedges that fill its rim; `layers` high.
[[nodiscard]] DataSet honeycomb(int rings, int layers, std::uint64_t seed,
                                const std::function<Vec3(const Vec3&)>& value);

/// Structured block at the given positions, x fastest.
[[nodiscard]] DataSet structured_block(const Index3& n, const std::vector<Vec3>& positions,
                                       const std::function<Vec3(const Vec3&)>& value);

/// [0, 1]^3 as 2 x 2 x 2 structured blocks whose axes are permuted and turned at random; coordinates differ
/// between blocks by up to `noise`.
[[nodiscard]] std::vector<DataSet> turned_blocks(int n, double noise, std::uint64_t seed,
                                                 const std::function<Vec3(const Vec3&)>& value);

/// A cylinder of radius 1 and height 1 as one structured block: the axis is a collapsed face, the first and
/// the last of the `around` + 1 planes are a seam.
[[nodiscard]] DataSet polar_block(int radial, int around, int high,
                                  const std::function<Vec3(const Vec3&)>& value);

/// The same tetrahedra with the points of their edges' middles (VTK type 24).
[[nodiscard]] DataSet quadratic_tetrahedra(const DataSet& linear,
                                           const std::function<Vec3(const Vec3&)>& value);

}  // namespace palpate::test
