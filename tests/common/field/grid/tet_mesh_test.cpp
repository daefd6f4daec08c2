#include "common/field/grid/tet_mesh.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/field/analytic/examples.h"
#include "common/field/grid/cell_split.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/sample_meshes.h"
#include "tests/support/sampled.h"

namespace palpate {
namespace {

/// Rounding of barycentric coordinates in well-shaped cells of a mesh of order one.
constexpr double kRounding = 1e-12;

Vec3 still(const Vec3&) { return {1.0, 0.0, 0.0}; }

std::unique_ptr<TetMesh> mesh_of(const DataSet& block) {
  SplitMesh split = split_into_tetrahedra(std::span(&block, 1), "test");
  return std::make_unique<TetMesh>(std::move(split.points), split.tets);
}

Vec3 random_point(std::mt19937_64& random) {
  const auto unit = [&] { return static_cast<double>(random() >> 11U) * 0x1p-53; };
  return {unit(), unit(), unit()};
}

/// The cell's coordinates give the point back, and none is far below zero.
void expect_holds(const TetMesh& mesh, const TetPoint& found, const Vec3& x) {
  ASSERT_NE(found.cell, kNoCell);
  ASSERT_FALSE(mesh.zero_volume(found.cell));
  EXPECT_NEAR(found.b[0] + found.b[1] + found.b[2] + found.b[3], 1.0, kRounding);
  EXPECT_LT(glm::distance(mesh.position(found.cell, found.b), x), kRounding);
  for (int i = 0; i < 4; ++i) EXPECT_GE(found.b[i], -1e-9);
}

TEST(TetMesh, NeighborsFaceEachOther) {
  const auto mesh = mesh_of(test::mixed_cells(4, 0.1, 1, still));
  std::size_t border = 0;
  for (std::size_t c = 0; c < mesh->cells().size(); ++c) {
    for (std::size_t i = 0; i < 4; ++i) {
      const CellIndex other = mesh->neighbors()[c][i];
      if (other == kNoCell) {
        ++border;
        continue;
      }
      const auto& behind = mesh->neighbors()[static_cast<std::size_t>(other)];
      const auto back = std::ranges::find(behind, static_cast<CellIndex>(c));
      ASSERT_NE(back, behind.end());
      // The cell behind face i has that face's vertices and not vertex i.
      const auto& v = mesh->cells()[static_cast<std::size_t>(other)];
      for (std::size_t j = 0; j < 4; ++j) {
        const bool shared = std::ranges::find(v, mesh->cells()[c][j]) != v.end();
        EXPECT_EQ(shared, j != i);
      }
    }
  }
  EXPECT_EQ(border, 2U * 6 * 16);
}

TEST(TetMesh, CellOrderNamesEveryCellOnce) {
  const DataSet block = test::mixed_cells(4, 0.1, 2, still);
  SplitMesh split = split_into_tetrahedra(std::span(&block, 1), "test");
  const TetMesh mesh(split.points, split.tets);
  std::vector<int> seen(split.tets.size(), 0);
  for (std::size_t c = 0; c < mesh.cells().size(); ++c) {
    ++seen[mesh.cell_order()[c]];
    auto mine = mesh.cells()[c];
    auto given = split.tets[mesh.cell_order()[c]];
    std::ranges::sort(mine);
    std::ranges::sort(given);
    EXPECT_EQ(mine, given);
  }
  EXPECT_TRUE(std::ranges::all_of(seen, [](int n) { return n == 1; }));
}

TEST(TetMesh, EveryPointOfTheDomainIsFoundFromAnyHint) {
  std::mt19937_64 random(3);
  for (const double jitter : {0.0, 0.2}) {
    const auto mesh = mesh_of(test::mixed_cells(6, jitter, 4, still));
    for (int i = 0; i < 5000; ++i) {
      const Vec3 x = random_point(random);
      TetPoint found;
      const auto hint = static_cast<CellIndex>(random() % mesh->cells().size());
      ASSERT_TRUE(mesh->locate(x, i % 2 == 0 ? kNoCell : hint, found));
      expect_holds(*mesh, found, x);
    }
  }
}

TEST(TetMesh, AnyHintIsAllowed) {
  const auto mesh = mesh_of(test::mixed_cells(3, 0.1, 4, still));
  for (const CellIndex hint :
       {kNoCell, -7, std::numeric_limits<CellIndex>::min(), std::numeric_limits<CellIndex>::max(),
        static_cast<CellIndex>(mesh->cells().size())}) {
    TetPoint found;
    EXPECT_TRUE(mesh->locate({0.3, 0.4, 0.5}, hint, found));
  }
}

// Vertices, points of edges and of faces: as the mesh itself gives their positions.
TEST(TetMesh, PointsOnFacesEdgesAndVerticesBelongToSomeCell) {
  std::mt19937_64 random(11);
  for (const double offset : {0.0, 1000.0}) {
    DataSet block = test::mixed_cells(4, 0.2, 5, still);
    SplitMesh split = split_into_tetrahedra(std::span(&block, 1), "test");
    for (Vec3& x : split.points) x += Vec3{offset};
    const TetMesh mesh(std::move(split.points), split.tets);
    for (std::size_t c = 0; c < mesh.cells().size(); ++c) {
      for (unsigned corners = 1; corners < 15; ++corners) {
        Vec4 b{0.0};
        double sum = 0.0;
        for (int i = 0; i < 4; ++i) {
          if (((corners >> static_cast<unsigned>(i)) & 1U) != 0) {
            b[i] = 0.01 + static_cast<double>(random() % 100);
            sum += b[i];
          }
        }
        const Vec3 x = mesh.position(static_cast<CellIndex>(c), b / sum);
        TetPoint found;
        const auto hint = static_cast<CellIndex>(random() % mesh.cells().size());
        ASSERT_TRUE(mesh.locate(x, hint, found)) << c << " " << corners;
        ASSERT_TRUE(mesh.locate(x, kNoCell, found)) << c << " " << corners;
        EXPECT_LT(glm::distance(mesh.position(found.cell, found.b), x), kRounding * (1.0 + offset));
      }
    }
  }
}

TEST(TetMesh, OutsideAndNaNBelongToNoCell) {
  const auto mesh = mesh_of(test::mixed_cells(3, 0.1, 6, still));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double inf = std::numeric_limits<double>::infinity();
  TetPoint found;
  for (const Vec3& x :
       {Vec3{1.0 + 1e-9, 0.5, 0.5}, Vec3{0.5, -1e-9, 0.5}, Vec3{0.5, 0.5, 3.0}, Vec3{nan, 0.5, 0.5},
        Vec3{0.5, 0.5, nan}, Vec3{inf, 0.5, 0.5}, Vec3{1e300, -1e300, 0.0}}) {
    EXPECT_FALSE(mesh->locate(x, kNoCell, found));
    EXPECT_FALSE(mesh->locate(x, 0, found));
  }
}

// An L of cubes: the straight way from one arm to the other leaves the mesh.
TEST(TetMesh, NonConvexMeshesAreSearchedBeyondTheirGaps) {
  DataSet block = test::sample_curvilinear(*example("cavity"), {9, 9, 9}, 0.2);
  block.visible.assign(9U * 9 * 9, 1);
  for (int k = 0; k < 9; ++k) {
    for (int j = 0; j < 9; ++j) {
      for (int i = 0; i < 9; ++i) {
        if (i > 2 && j > 2) block.visible[static_cast<std::size_t>(i + 9 * (j + 9 * k))] = 0;
      }
    }
  }
  const auto mesh = mesh_of(block);
  std::mt19937_64 random(8);
  int inside = 0;
  for (int i = 0; i < 5000; ++i) {
    const Vec3 x = random_point(random);
    TetPoint from_index;
    TetPoint from_hint;
    const bool found = mesh->locate(x, kNoCell, from_index);
    const auto hint = static_cast<CellIndex>(random() % mesh->cells().size());
    ASSERT_EQ(mesh->locate(x, hint, from_hint), found);
    // Away from the warped inner border both answers are known.
    if (x.x < 0.2 || x.y < 0.2) {
      EXPECT_TRUE(found);
    }
    if (x.x > 0.3 && x.y > 0.3) {
      EXPECT_FALSE(found);
    }
    inside += found ? 1 : 0;
  }
  EXPECT_GT(inside, 1000);
}

/// A cube with one inner point, moved towards a face until its cells are `height` high.
TetMesh sliver_mesh(double height) {
  std::vector<Vec3> points;
  for (int i = 0; i < 8; ++i) points.emplace_back(i & 1, (i >> 1) & 1, i >> 2);
  points.emplace_back(0.375, 0.5625, height);
  std::vector<TetMesh::Tet> cells;
  const std::array<std::array<std::uint32_t, 4>, 6> faces{
      {{0, 1, 3, 2}, {4, 6, 7, 5}, {0, 4, 5, 1}, {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 5, 7, 3}}};
  for (const auto& f : faces) {
    cells.push_back({8, f[0], f[1], f[2]});
    cells.push_back({8, f[0], f[2], f[3]});
  }
  return {std::move(points), cells};
}

TEST(TetMesh, SliversAreLocatedAndFlatCellsAreFlagged) {
  std::mt19937_64 random(21);
  for (const double height : {1e-3, 1e-6, 1e-9, 1e-11, 1e-13, 1e-15, 0.0}) {
    SCOPED_TRACE(height);
    const TetMesh mesh = sliver_mesh(height);
    const bool flat = height < 0x1p-40;
    EXPECT_EQ(mesh.zero_volume_count(), flat ? 2U : 0U);
    for (int i = 0; i < 2000; ++i) {
      Vec3 x = random_point(random);
      if (i % 2 == 0) x.z *= 2.0 * height;  // into the slivers and their faces
      if (i % 8 == 0) x.z = 0.0;
      TetPoint found;
      ASSERT_TRUE(mesh.locate(x, i % 3 == 0 ? static_cast<CellIndex>(i % 12) : kNoCell, found)) << i;
      ASSERT_FALSE(mesh.zero_volume(found.cell));
      EXPECT_LT(glm::distance(mesh.position(found.cell, found.b), x), kRounding);
    }
    for (std::uint32_t v = 0; v < 9; ++v) {
      TetPoint found;
      EXPECT_TRUE(mesh.locate(mesh.points()[v], kNoCell, found));
    }
  }
}

TEST(TetMesh, InvertedCellsAreTurnedAndCounted) {
  const DataSet block = test::mixed_cells(3, 0.1, 9, still);
  SplitMesh split = split_into_tetrahedra(std::span(&block, 1), "test");
  for (std::size_t t = 0; t < split.tets.size(); t += 3) std::swap(split.tets[t][0], split.tets[t][1]);
  const TetMesh mesh(split.points, split.tets);
  EXPECT_EQ(mesh.inverted_count(), (split.tets.size() + 2) / 3);
  for (const auto& v : mesh.cells()) {
    const auto& p = mesh.points();
    EXPECT_GT(glm::dot(glm::cross(p[v[1]] - p[v[0]], p[v[2]] - p[v[0]]), p[v[3]] - p[v[0]]), 0.0);
  }
}

TEST(TetMesh, PointsInNoCellAreNotCountedAsUsed) {
  const std::vector<Vec3> points{{0, 0, 0}, {9, 9, 9}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}, {8, 8, 8}};
  const TetMesh mesh(points, std::vector<TetMesh::Tet>{{0, 2, 3, 4}, {2, 3, 4, 5}});
  EXPECT_EQ(mesh.used_point_count(), 5U);
}

TEST(TetMesh, MeshesThatAreNoneAreRefused) {
  const std::vector<Vec3> points{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  EXPECT_THROW(TetMesh(points, {}), Error);
  const std::vector<TetMesh::Tet> far{{0, 1, 2, 4}};
  EXPECT_THROW(TetMesh(points, far), Error);
  std::vector<Vec3> bad = points;
  bad[2].y = std::numeric_limits<double>::quiet_NaN();
  const std::vector<TetMesh::Tet> one{{0, 1, 2, 3}};
  EXPECT_THROW(TetMesh(bad, one), Error);
  EXPECT_NO_THROW(TetMesh(points, one));
}

TEST(TetMesh, CellsOverOneAnotherAreNoNeighbours) {
  const std::vector<Vec3> points{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0.2, 0.2, 2}, {0, 0, -1}};
  const std::vector<TetMesh::Tet> cells{{0, 1, 2, 3}, {0, 1, 2, 4}, {0, 1, 2, 5}};
  const TetMesh mesh(points, cells);
  EXPECT_EQ(mesh.overlapping_face_count(), 1U);
  std::array<CellIndex, 3> behind{};  // of each cell as given
  for (std::size_t c = 0; c < 3; ++c) {
    behind[mesh.cell_order()[c]] = kNoCell;
    for (const CellIndex cell : mesh.neighbors()[c])
      if (cell != kNoCell)
        behind[mesh.cell_order()[c]] = static_cast<CellIndex>(mesh.cell_order()[as_size(cell)]);
  }
  EXPECT_EQ(behind, (std::array<CellIndex, 3>{2, kNoCell, 0}));
  TetPoint found;
  EXPECT_TRUE(mesh.locate({0.1, 0.1, -0.3}, 0, found));
}

// Cells that a file has twice: each has a neighbour across, none beside itself, and the border is the border.
TEST(TetMesh, DoubledCellsKeepTheBorder) {
  const std::vector<Vec3> points{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, -1}};
  const std::vector<TetMesh::Tet> cells{{0, 1, 2, 3}, {0, 2, 1, 4}, {1, 2, 0, 3}, {0, 2, 1, 4}};
  const TetMesh mesh(points, cells);
  for (std::size_t c = 0; c < 4; ++c) {
    int neighbours = 0;
    for (const CellIndex next : mesh.neighbors()[c]) {
      if (next == kNoCell) continue;
      ++neighbours;
      EXPECT_NE(mesh.cell_order()[as_size(next)] % 2, mesh.cell_order()[c] % 2);
    }
    EXPECT_EQ(neighbours, 1);
  }
}

// Sizes of 1, 1e-3 and 1e-6 along the axes, and half of all cells in a corner of 1e-4 of the size.
TEST(TetMesh, StretchedAndGradedMeshesAreLocated) {
  const DataSet block = test::mixed_cells(6, 0.1, 14, still);
  SplitMesh split = split_into_tetrahedra(std::span(&block, 1), "test");
  const auto stretch = [](const Vec3& x) { return x * Vec3(1.0, 1e-3, 1e-6); };
  const auto grade = [](const Vec3& x) {
    return Vec3(x.x < 0.5 ? 2e-4 * x.x : 1e-4 + (x.x - 0.5) * 2.0 * (1.0 - 1e-4), x.y, x.z);
  };
  std::vector<Vec3> stretched;
  std::vector<Vec3> graded;
  for (const Vec3& x : split.points) {
    stretched.push_back(stretch(x));
    graded.push_back(grade(x));
  }
  const TetMesh first(stretched, split.tets);
  const TetMesh second(graded, split.tets);
  std::mt19937_64 random(4);
  for (int i = 0; i < 2000; ++i) {
    const Vec3 x = random_point(random);
    TetPoint found;
    ASSERT_TRUE(first.locate(stretch(x), kNoCell, found));
    ASSERT_TRUE(second.locate(grade(x), kNoCell, found));
  }
}

// Coordinates times a power of two: the same cells and the same bits of barycentric coordinates.
TEST(TetMesh, PowersOfTwoChangeNothing) {
  const DataSet block = test::mixed_cells(4, 0.2, 12, still);
  SplitMesh split = split_into_tetrahedra(std::span(&block, 1), "test");
  const TetMesh mesh(split.points, split.tets);
  std::vector<Vec3> scaled = split.points;
  for (Vec3& x : scaled) x *= 0x1p60;
  const TetMesh other(std::move(scaled), split.tets);
  EXPECT_TRUE(std::ranges::equal(mesh.cells(), other.cells()));
  EXPECT_TRUE(std::ranges::equal(mesh.neighbors(), other.neighbors()));
  std::mt19937_64 random(1);
  for (int i = 0; i < 2000; ++i) {
    const Vec3 x = random_point(random);
    TetPoint a;
    TetPoint b;
    ASSERT_EQ(mesh.locate(x, kNoCell, a), other.locate(x * 0x1p60, kNoCell, b));
    EXPECT_EQ(a.cell, b.cell);
    EXPECT_EQ(a.b, b.b);
  }
}

// Coordinates that are single-precision numbers are walked in a smaller layout: the same numbers, the same
// bits. A point that no cell uses, and that is no such number, switches it off.
TEST(TetMesh, SinglePrecisionCoordinatesGiveTheSameBits) {
  const DataSet block = test::mixed_cells(4, 0.2, 13, still);
  SplitMesh split = split_into_tetrahedra(std::span(&block, 1), "test");
  for (Vec3& x : split.points) x = Vec3(Vec3f(x));
  const TetMesh mesh(split.points, split.tets);
  split.points.emplace_back(0.1, 0.2, 0.3);
  const TetMesh other(split.points, split.tets);
  std::mt19937_64 random(1);
  for (int i = 0; i < 2000; ++i) {
    const Vec3 x = random_point(random);
    TetPoint a;
    TetPoint b;
    ASSERT_EQ(mesh.locate(x, kNoCell, a), other.locate(x, kNoCell, b));
    EXPECT_EQ(a.cell, b.cell);
    EXPECT_EQ(a.b, b.b);
  }
}

TEST(TetMesh, TheNumberOfThreadsChangesNothing) {
  const DataSet block = test::sample_tetrahedra(*example("cavity"), {24, 24, 24});
  SplitMesh split = split_into_tetrahedra(std::span(&block, 1), "test");
  const TetMesh one(split.points, split.tets, 1);
  const TetMesh two(split.points, split.tets, 2);
  EXPECT_TRUE(std::ranges::equal(one.cells(), two.cells()));
  EXPECT_TRUE(std::ranges::equal(one.neighbors(), two.neighbors()));
}

TEST(TetMesh, LocateAllocatesNothing) {
  const TetMesh flat = sliver_mesh(0.0);
  const auto mesh = mesh_of(test::mixed_cells(4, 0.2, 5, still));
  std::mt19937_64 random(2);
  const test::AllocationGuard guard;
  for (int i = 0; i < 2000; ++i) {
    const Vec3 x = 1.2 * random_point(random);
    TetPoint found;
    (void)mesh->locate(x, static_cast<CellIndex>(random() % 100), found);
    (void)flat.locate(x, kNoCell, found);
  }
  EXPECT_EQ(guard.count(), 0U);
}

}  // namespace
}  // namespace palpate
