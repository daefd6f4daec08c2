#include "common/field/grid/cell_split.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/field/analytic/examples.h"
#include "tests/support/mesh_check.h"
#include "tests/support/sample_meshes.h"
#include "tests/support/sampled.h"

namespace palpate {
namespace {

using test::check_mesh;
using test::MeshCheck;

/// Rounding of sums of some thousand volumes and areas of order one.
constexpr double kRounding = 1e-12;

Vec3 still(const Vec3&) { return {1.0, 0.0, 0.0}; }

MeshCheck check(const SplitMesh& mesh) { return check_mesh(mesh.points, mesh.tets); }

SplitMesh split(const DataSet& block) { return split_into_tetrahedra(std::span(&block, 1), "test"); }

/// A proper mesh of the unit cube: every inner face has two cells, the border is the cube's, and so is the
/// volume; no cell is turned.
void expect_unit_cube(const SplitMesh& mesh) {
  const MeshCheck found = check(mesh);
  EXPECT_EQ(found.crowded_faces, 0U);
  EXPECT_EQ(found.inverted, 0U);
  EXPECT_NEAR(found.volume, 1.0, kRounding);
  EXPECT_NEAR(found.border_area, 6.0, kRounding);
  for (const auto& face : found.border) {
    bool on_side = false;
    for (int axis = 0; axis < 3; ++axis) {
      for (const double side : {0.0, 1.0}) {
        on_side = on_side || (mesh.points[face[0]][axis] == side && mesh.points[face[1]][axis] == side &&
                              mesh.points[face[2]][axis] == side);
      }
    }
    EXPECT_TRUE(on_side);
  }
}

TEST(CellSplit, StructuredBlockGivesFiveTetrahedraAHexahedron) {
  const DataSet block = test::sample_curvilinear(*example("cavity"), {6, 5, 7});
  const SplitMesh mesh = split(block);
  EXPECT_EQ(mesh.tets.size(), 5U * 5 * 4 * 6);
  EXPECT_EQ(mesh.merged_points, 0U);
  expect_unit_cube(mesh);
}

TEST(CellSplit, MixedCellsInAnyOrderShareTheirFaces) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    expect_unit_cube(split(test::mixed_cells(4, 0.15, seed, still)));
  }
}

// Polyhedra with coplanar faces: the cone over a face in the apex's own plane is flat, and two cells may
// have the same flat tetrahedra.
TEST(CellSplit, PolyhedraWithCoplanarFacesShareThem) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    expect_unit_cube(split(test::mixed_cells(4, 0.0, seed, still)));
  }
}

// A jitter of half a cube folds some of them; faces agree all the same.
TEST(CellSplit, FacesAgreeEvenBetweenFoldedCells) {
  std::size_t folded = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const SplitMesh mesh = split(test::mixed_cells(4, 0.6, seed, still));
    const MeshCheck found = check(mesh);
    EXPECT_EQ(found.crowded_faces, 0U);
    EXPECT_EQ(found.border_faces, 2U * 6 * 4 * 4);  // two a quadrilateral of the border
    // Overlaps count twice in the sum of volumes, while signed volumes still add up.
    EXPECT_GE(found.volume, 1.0 - kRounding);
    folded += mesh.folded_cells;
  }
  EXPECT_GT(folded, 0U);
}

TEST(CellSplit, PrismsOfAnyBaseShareTheirFaces) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const int rings = 2;
    const SplitMesh mesh = split(test::honeycomb(rings, 3, seed, still));
    const MeshCheck found = check(mesh);
    const double hexagon = 1.5 * std::numbers::sqrt3;
    const double hexagons = 1.0 + 3.0 * rings * (rings + 1);
    EXPECT_EQ(found.crowded_faces, 0U);
    EXPECT_EQ(found.inverted, 0U);
    EXPECT_EQ(mesh.inverted_cells, 0U);
    EXPECT_NEAR(found.volume, 1.5 * hexagon * hexagons, 1e-9);
    // Top, bottom and a rim of 6 (2 rings + 1) sides of length one, height 1.5.
    EXPECT_NEAR(found.border_area, 2.0 * hexagon * hexagons + 1.5 * 6.0 * (2 * rings + 1), 1e-9);
  }
}

TEST(CellSplit, BlocksInAnyOrientationAreJoined) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const auto blocks = test::turned_blocks(3, 0.0, seed, still);
    const SplitMesh mesh = split_into_tetrahedra(blocks, "test");
    EXPECT_EQ(mesh.points.size(), 7U * 7 * 7);
    EXPECT_EQ(mesh.merged_points, 8U * 64 - 343);
    EXPECT_EQ(mesh.inverted_cells, 0U);
    expect_unit_cube(mesh);
  }
}

// Writers round coordinates block by block; 1e-6 of the size is far below 2^-10 of a cell.
TEST(CellSplit, BlocksWhoseBordersDifferByRoundingAreJoined) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const auto blocks = test::turned_blocks(3, 1e-6, seed, still);
    const SplitMesh mesh = split_into_tetrahedra(blocks, "test");
    EXPECT_EQ(mesh.points.size(), 7U * 7 * 7);
    const MeshCheck found = check(mesh);
    EXPECT_EQ(found.crowded_faces, 0U);
    EXPECT_NEAR(found.border_area, 6.0, 1e-4);
  }
}

TEST(CellSplit, PointsFartherApartThanTheToleranceStayApart) {
  const auto blocks = test::turned_blocks(3, 0.02, 1, still);
  EXPECT_EQ(split_into_tetrahedra(blocks, "test").merged_points, 0U);
}

// Pieces of a parallel run hold cells of their neighbours too.
TEST(CellSplit, RepeatedCellsCountOnce) {
  const DataSet block = test::sample_tetrahedra(*example("cavity"), {5, 5, 5});
  const std::vector<DataSet> blocks{block, block};
  const SplitMesh mesh = split_into_tetrahedra(blocks, "test");
  EXPECT_EQ(mesh.repeated_tets, 5U * 64);
  expect_unit_cube(mesh);
}

// The axis collapses hexahedra to wedges, the seam joins the first plane to the last.
TEST(CellSplit, PolarBlockHasNeitherHoleNorSeam) {
  for (const int around : {8, 9}) {
    const SplitMesh mesh = split(test::polar_block(4, around, 3, still));
    const MeshCheck found = check(mesh);
    const double polygon = 0.5 * around * std::sin(2.0 * std::numbers::pi / around);
    const double side = 2.0 * std::sin(std::numbers::pi / around);
    EXPECT_EQ(found.crowded_faces, 0U);
    EXPECT_EQ(found.inverted, 0U);
    EXPECT_NEAR(found.volume, polygon, kRounding);
    EXPECT_NEAR(found.border_area, 2.0 * polygon + around * side, kRounding);
  }
}

TEST(CellSplit, LeftHandedBlocksAreTurnedWithoutComplaint) {
  std::vector<Vec3> positions;
  for (int k = 0; k < 4; ++k) {
    for (int j = 0; j < 4; ++j) {
      for (int i = 3; i >= 0; --i) positions.push_back(Vec3(i, j, k) / 3.0);
    }
  }
  const SplitMesh mesh = split(test::structured_block({4, 4, 4}, positions, still));
  EXPECT_EQ(mesh.left_handed_blocks, 1U);
  EXPECT_EQ(mesh.inverted_cells, 0U);
  expect_unit_cube(mesh);
}

TEST(CellSplit, OneInvertedTetrahedronIsCountedAndTurned) {
  DataSet block = test::sample_tetrahedra(*example("cavity"), {4, 4, 4});
  auto& topology = std::get<UnstructuredTopology>(block.topology);
  std::swap(topology.connectivity[40], topology.connectivity[41]);
  const SplitMesh mesh = split(block);
  EXPECT_EQ(mesh.inverted_cells, 1U);
  expect_unit_cube(mesh);
}

TEST(CellSplit, TenNodeTetrahedraBecomeEightLinearOnes) {
  const DataSet linear = test::sample_tetrahedra(*example("cavity"), {4, 4, 4});
  const SplitMesh mesh = split(test::quadratic_tetrahedra(linear, still));
  EXPECT_EQ(mesh.tets.size(), 8U * 5 * 27);
  EXPECT_EQ(mesh.refined_cells, 5U * 27);
  expect_unit_cube(mesh);
}

TEST(CellSplit, TenNodeTetrahedraBesideOtherCellsKeepTheirCornersAlone) {
  const DataSet linear = test::sample_tetrahedra(*example("cavity"), {4, 4, 4});
  const std::vector<DataSet> blocks{test::quadratic_tetrahedra(linear, still), linear};
  const SplitMesh mesh = split_into_tetrahedra(blocks, "test");
  EXPECT_EQ(mesh.corner_cells, 5U * 27);
  EXPECT_EQ(mesh.repeated_tets, 5U * 27);
  expect_unit_cube(mesh);
}

TEST(CellSplit, BlankedPointsTakeTheirCellsAlong) {
  DataSet block = test::sample_curvilinear(*example("cavity"), {5, 5, 5});
  block.visible.assign(125, 1);
  block.visible[62] = 0;  // the middle
  const SplitMesh mesh = split(block);
  EXPECT_EQ(mesh.blanked_cells, 8U);
  EXPECT_EQ(mesh.tets.size(), 5U * 56);
  EXPECT_EQ(mesh.point_of_input[62], kNoPoint);
  EXPECT_EQ(mesh.points.size(), 124U);
}

/// What splitting says of a topology that is wrong.
std::string refusal(const DataSet& block) {
  try {
    (void)split(block);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::kBadInput);
    return error.what();
  }
  return {};
}

DataSet hexahedra() {
  DataSet block = test::mixed_cells(2, 0.1, 3, still);
  return block;
}

TEST(CellSplit, HostileTopologiesAreRefusedInOneLine) {
  using Spoil = void (*)(UnstructuredTopology&);
  const std::array<Spoil, 9> spoils{
      [](UnstructuredTopology& t) { t.connectivity.back() = 1'000'000; },
      [](UnstructuredTopology& t) { t.connectivity.back() = -1; },
      [](UnstructuredTopology& t) { t.offsets[1] = -5; },
      [](UnstructuredTopology& t) { t.offsets.back() = std::int64_t{1} << 60; },
      [](UnstructuredTopology& t) { std::swap(t.offsets[1], t.offsets[2]); },
      [](UnstructuredTopology& t) { t.offsets.pop_back(); },
      [](UnstructuredTopology& t) { t.positions.components = 2; },
      [](UnstructuredTopology& t) { t.positions.tuples = std::size_t{1} << 40; },
      [](UnstructuredTopology& t) { t.types.assign(t.types.size(), 3); },
  };
  for (std::size_t i = 0; i < spoils.size(); ++i) {
    SCOPED_TRACE(i);
    DataSet block = hexahedra();
    block.arrays.clear();
    spoils[i](std::get<UnstructuredTopology>(block.topology));
    const std::string line = refusal(block);
    EXPECT_FALSE(line.empty());
    EXPECT_EQ(line.find('\n'), std::string::npos);
  }
}

TEST(CellSplit, EveryFaceStreamIsReadWithinItsBounds) {
  std::mt19937_64 random(5);
  for (int round = 0; round < 300; ++round) {
    DataSet block = hexahedra();
    auto& topology = std::get<UnstructuredTopology>(block.topology);
    for (int i = 0; i < 3; ++i) {
      topology.connectivity[random() % topology.connectivity.size()] =
          static_cast<std::int64_t>(random()) >> (random() % 64);
    }
    for (auto& type : topology.types) {
      if (random() % 8 == 0) type = static_cast<std::uint8_t>(random());
    }
    (void)refusal(block);  // either way, within the sanitizers
  }
}

TEST(CellSplit, ClaimedSizesAreNotAllocated) {
  DataSet block;
  UniformTopology topology;
  topology.points = {1 << 20, 1 << 20, 2};
  block.topology = topology;
  EXPECT_FALSE(refusal(block).empty());
  topology.points = {1 << 30, 1 << 30, 1 << 30};
  block.topology = topology;
  EXPECT_FALSE(refusal(block).empty());
  block.topology = StructuredTopology{{1 << 20, 1 << 20, 1 << 10}, {}};
  EXPECT_FALSE(refusal(block).empty());
}

TEST(CellSplit, FlatGridsAreNamedAsSuch) {
  std::vector<Vec3> positions;
  for (int j = 0; j < 4; ++j) {
    for (int i = 0; i < 4; ++i) positions.emplace_back(i, j, 0.0);
  }
  const std::string line = refusal(test::structured_block({4, 4, 1}, positions, still));
  EXPECT_NE(line.find("no three-dimensional cells"), std::string::npos) << line;
}

// Splitting sees the order of lengths alone: data times 2^60 gives the same mesh.
TEST(CellSplit, PowersOfTwoGiveTheSameTetrahedra) {
  const DataSet block = test::mixed_cells(4, 0.3, 7, still);
  const SplitMesh mesh = split(block);
  for (const int exponent : {60, -60, 900, -900}) {
    DataSet scaled = block;
    auto& topology = std::get<UnstructuredTopology>(scaled.topology);
    std::vector<double> numbers;
    for (std::size_t p = 0; p < topology.positions.tuples; ++p) {
      for (int c = 0; c < 3; ++c) numbers.push_back(std::ldexp(topology.positions.at(p, c), exponent));
    }
    topology.positions = make_array("points", Association::kPoint, 3, std::span<const double>(numbers));
    const SplitMesh other = split(scaled);
    EXPECT_EQ(other.tets, mesh.tets);
    EXPECT_EQ(other.folded_cells, mesh.folded_cells);
  }
}

}  // namespace
}  // namespace palpate
