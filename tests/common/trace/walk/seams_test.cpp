// Lines through meshes whose cells share no points where they meet: points of their own, hanging nodes, blocks that
// meet shifted; those that overlap are in overlaps_test.cpp. The reference is the closed form of u = (-y, x, 0.3).

#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/field/analytic/analytic_field.h"
#include "common/field/cells/constant_cells.h"
#include "common/field/grid/tet_mesh.h"
#include "common/field/grid/tet_seams.h"
#include "common/trace/trace.h"
#include "tests/common/trace/walk/seam_meshes.h"

namespace palpate {
namespace {

using namespace test::seams;

TEST(Seams, CellsWithPointsOfTheirOwnAreOneMesh) {
  for (const std::uint8_t type : {10, 12, 13, 14}) {
    SCOPED_TRACE(int{type});
    OwnPoints cells(0.0, 0.0);
    cells.add_box(type, {-1, -1, 0}, {1, 1, 2}, {6, 5, 7});
    const Field field = field_of({cells.take()});
    EXPECT_TRUE(noted(field, "joined with one at the same place"));
    EXPECT_EQ(find_seams(*field->tet_mesh(), 1).faces, 0U);
    EXPECT_EQ(field->tet_mesh()->points().size(), type == 14 ? 6 * 5 * 7 + 7 * 6 * 8U : 7 * 6 * 8U);
    expect_helices(field, 1e-7);
  }
}

TEST(Seams, PointsThatAreEqualToTheLastDigitButOneAreJoined) {
  for (const std::uint8_t type : {10, 12, 13, 14}) {
    SCOPED_TRACE(int{type});
    OwnPoints cells(1e-7, 0.0);
    cells.add_box(type, {-1, -1, 0}, {1, 1, 2}, {6, 5, 7});
    const Field field = field_of({cells.take()});
    EXPECT_EQ(find_seams(*field->tet_mesh(), 1).faces, 0U);
    expect_helices(field, 1e-5);
  }
}

TEST(Seams, LinesCrossHangingNodes) {
  for (const std::uint8_t type : {10, 12, 13, 14}) {
    for (const std::uint8_t other : {10, 12, 13, 14}) {
      SCOPED_TRACE(int{type});
      SCOPED_TRACE(int{other});
      OwnPoints cells(0.0, 0.0);
      cells.add_box(type, {-1, -1, 0}, {1, 1, 0.8}, {5, 5, 3});
      cells.add_box(other, {-1, -1, 0.8}, {1, 1, 2}, {10, 10, 9});
      const Field field = field_of({cells.take()});
      EXPECT_TRUE(noted(field, "lines cross there by location"));
      expect_helices(field, 1e-6);
    }
  }
}

TEST(Seams, LinesCrossBlocksOfAllKindsThatMeetShifted) {
  for (const int kind : kBlockKinds) {
    for (const int other : kBlockKinds) {
      SCOPED_TRACE(kind);
      SCOPED_TRACE(other);
      const Field field = field_of({block_of(kind, {5, 4, 6}, {-1, -1, 0}, {0.1, 1, 2}),
                                    block_of(other, {3, 7, 5}, {0.1, -1, 0}, {1, 1, 2})});
      EXPECT_FALSE(noted(field, "overlap"));
      expect_helices(field, 1e-6);
    }
  }
}

TEST(Seams, JumpsCountIntoTheError) {
  for (const std::uint8_t type : {10, 12, 13, 14}) {
    SCOPED_TRACE(int{type});
    OwnPoints cells(0.0, 1e-3);
    cells.add_box(type, {-1, -1, 0}, {1, 1, 2}, {6, 5, 7});
    const Field field = field_of({cells.take()});
    EXPECT_TRUE(noted(field, "jump by up to"));
    const std::vector<Vec3> from = seeds(40);
    for (const Integrator integrator : {Integrator::kExact, Integrator::kDp54}) {
      TraceOptions options;
      options.integrator = integrator;
      options.threads = 1;
      for (const Line& line : trace_lines(*field, from, options).lines) {
        const LinePoint& last = line.points.back();
        EXPECT_EQ(line.end, End::kLeftDomain) << name_of(line.end) << " seed " << line.seed;
        const double side = std::max(std::abs(last.position.x), std::abs(last.position.y));
        EXPECT_NEAR(std::max(side, last.position.z - 1.0), 1.0, 1e-6) << "seed " << line.seed;
        EXPECT_LE(glm::distance(last.position, on_helix(from[line.seed], last.time)), last.error)
            << "seed " << line.seed;
        EXPECT_LT(last.error, 1.0);
      }
    }
  }
}

/// Values constant over the n unit cubes of a lattice from the origin.
struct ConstantCubes {
  Index3 n{0};
  std::vector<Vec3> values;

  [[nodiscard]] Field field() const {
    DataSet block;
    block.topology = UniformTopology{.points = n + 1, .origin = Vec3{0.0}, .axes = Mat3{1.0}};
    std::vector<double> numbers;
    for (const Vec3& v : values) numbers.insert(numbers.end(), {v.x, v.y, v.z});
    block.arrays = {make_array("v", Association::kCell, 3, std::span<const double>(numbers))};
    const ConstantCells made =
        constant_cells({block}, {VectorChoice::Kind::kArray, Association::kCell, {"v"}, "v"});
    return make_vector_field(made.blocks, made.choice, "test");
  }
  /// Where the flow carries x in so long a time, or where it leaves. @pre it goes up along each axis.
  [[nodiscard]] Vec3 carried(Vec3 x, double time) const {
    Index3 cell(glm::floor(x));
    while (cell.x < n.x && cell.y < n.y && cell.z < n.z) {
      const Vec3 v = values[static_cast<std::size_t>(cell.x + n.x * (cell.y + n.y * cell.z))];
      int axis = 0;
      double step = HUGE_VAL;
      for (int a = 0; a < 3; ++a) {
        const double to_face = (cell[a] + 1 - x[a]) / v[a];
        if (to_face < step) {
          step = to_face;
          axis = a;
        }
      }
      if (step >= time) return x + time * v;
      x += step * v;
      x[axis] = ++cell[axis];
      time -= step;
    }
    return x;
  }
};

TEST(Seams, LinesOfConstantCellsAreExact) {
  ConstantCubes cubes{{6, 5, 7}, {}};
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> part(0.05, 1.0);
  for (int c = 0; c < 6 * 5 * 7; ++c) {
    const double x = part(random), y = part(random);
    cubes.values.emplace_back(x, y, part(random));
  }
  std::vector<Vec3> from;
  for (int s = 0; s < 40; ++s) {
    const double x = 4.0 * part(random), y = 3.0 * part(random);
    from.emplace_back(x, y, 5.0 * part(random));
  }
  const Field field = cubes.field();
  for (const Integrator integrator : {Integrator::kExact, Integrator::kDp54}) {
    SCOPED_TRACE(name_of(integrator));
    TraceOptions options;
    options.integrator = integrator;
    options.threads = 1;
    double largest = 0.0;
    for (const Line& line : trace_lines(*field, from, options).lines) {
      EXPECT_EQ(line.end, End::kLeftDomain) << name_of(line.end) << " seed " << line.seed;
      for (const LinePoint& point : line.points) {
        EXPECT_LE(glm::distance(point.position, cubes.carried(from[line.seed], point.time)),
                  1e-9 + point.error)
            << line.seed;
        largest = std::max(largest, point.error);
      }
      const Vec3& end = line.points.back().position;
      EXPECT_NEAR(std::max({end.x / 6.0, end.y / 5.0, end.z / 7.0}), 1.0, 1e-9);
    }
    EXPECT_LT(largest, 1e-6) << "no jump is an error";
  }
}

TEST(Seams, AnErrorGrowsAtAJumpAsTheFlowDoes) {
  // Slowly towards the face and fast behind it: who is late by e is off by as much as the flow goes in that time.
  const ConstantCubes cubes{{2, 1, 1}, {{0.01, 0.5, 0.0}, {1.0, 0.0, 0.0}}};
  const Field field = cubes.field();
  TraceOptions options;
  options.threads = 1;
  const std::vector<Vec3> from{{0.999, 0.2, 0.3}};
  const TraceResult result = trace_lines(*field, from, options);
  const Line& line = result.lines.front();
  EXPECT_GT(line.points.back().error, 5.0 * line.points.front().error);
  EXPECT_LT(line.points.back().error, 1e-10);
}

TEST(Seams, CellsThatPointAtTheirFaceEndTheLine) {
  const ConstantCubes cubes{{2, 1, 1}, {{1.0, 0.1, 0.0}, {-0.5, 0.1, 0.0}}};
  const Field field = cubes.field();
  const std::vector<Vec3> from{{0.3, 0.2, 0.4}, {1.7, 0.3, 0.6}};
  for (const Integrator integrator : {Integrator::kExact, Integrator::kDp54, Integrator::kRk4}) {
    SCOPED_TRACE(name_of(integrator));
    TraceOptions options;
    options.integrator = integrator;
    options.threads = 1;
    for (const Line& line : trace_lines(*field, from, options).lines) {
      EXPECT_EQ(line.end, End::kOpposedCells) << name_of(line.end);
      EXPECT_NEAR(line.points.back().position.x, 1.0, 1e-12);
    }
    options.forward = false;
    options.backward = true;
    for (const Line& line : trace_lines(*field, from, options).lines) EXPECT_EQ(line.end, End::kLeftDomain);
  }
}

TEST(Seams, TheBorderOfAMeshWithoutThemIsItsEnd) {
  const Field field = field_of({lattice({4, 4, 4}, {-1, -1, 0}, {1, 1, 2})});
  EXPECT_EQ(find_seams(*field->tet_mesh(), 1).faces, 0U);
  EXPECT_EQ(find_seams(*field->tet_mesh(), 1).overlapping, 0U);
  EXPECT_EQ(find_seams(*field->tet_mesh(), 1).border_faces, 6U * 16 * 2);
  // Two blocks apart by a tenth of a cell are two domains.
  const Field apart =
      field_of({lattice({4, 4, 4}, {-1, -1, 0}, {1, 1, 0.95}), lattice({4, 4, 4}, {-1, -1, 1.0}, {1, 1, 2})});
  EXPECT_EQ(find_seams(*apart->tet_mesh(), 1).faces, 0U);
}

/// Air that moves along x beside, or towards, a block of what is all but still.
Field beside_a_block(const DataSet& grid, const std::vector<Vec3>& points, bool towards, double still) {
  std::vector<double> value;
  for (const Vec3& x : points) {
    const bool solid = x.x > 0.5 - 1e-9;
    // Noise of a solver, without divergence or sense.
    const Vec3 noise = still * Vec3{std::sin(31 * x.y), std::cos(17 * x.z), std::sin(23 * x.x)};
    const double near = 0.5 - x.x;
    const Vec3 air = towards ? Vec3{near, -0.5 * x.y, 0.2 * near} : Vec3{0.0, 1.0, 0.0};
    const Vec3 v = solid ? noise : air;
    value.insert(value.end(), {v.x, v.y, v.z});
  }
  DataSet block = grid;
  block.arrays = {make_array("velocity", Association::kPoint, 3, std::span<const double>(value))};
  return field_of({block});
}

TEST(DeadCells, LinesEndThereAsStagnation) {
  constexpr int kPoints = 9;
  std::vector<Vec3> points;
  for (int i = 0; i < kPoints * kPoints * kPoints; ++i)
    points.emplace_back(0.125 * (i % kPoints), 0.125 * (i / kPoints % kPoints) - 0.5,
                        0.125 * (i / kPoints / kPoints));
  DataSet box;
  box.topology = UniformTopology{.points = Index3(kPoints), .origin = points.front(), .axes = Mat3(0.125)};
  const DataSet cells = test::structured_block(Index3(kPoints), points, helix);
  for (const double still : {1e-14, 1e-16, 1e-30}) {
    for (const bool towards : {false, true}) {
      for (const bool tetrahedra : {false, true}) {
        const Field field = beside_a_block(tetrahedra ? cells : box, points, towards, still);
        EXPECT_TRUE(noted(field, "taken as at rest"));
        for (const Integrator integrator : {Integrator::kExact, Integrator::kDp54, Integrator::kRk4}) {
          if (integrator == Integrator::kExact && !tetrahedra) continue;
          SCOPED_TRACE(name_of(integrator));
          TraceOptions options;
          options.integrator = integrator;
          options.backward = !towards;
          options.threads = 1;
          options.max_steps = 20000;
          std::vector<Vec3> from;
          for (int i = 0; i < 20; ++i)
            from.emplace_back(towards ? 0.02 * i : 0.55 + 0.02 * i, 0.03 * i - 0.3, 0.1 + 0.02 * i);
          for (const Line& line : trace_lines(*field, from, options).lines) {
            EXPECT_EQ(line.end, End::kStagnation) << name_of(line.end) << " seed " << line.seed << " towards "
                                                  << towards << " tets " << tetrahedra << " still " << still;
            if (integrator != Integrator::kRk4) {
              EXPECT_LT(line.points.back().time, 1e6);
            }
          }
        }
      }
    }
  }
}

}  // namespace
}  // namespace palpate
