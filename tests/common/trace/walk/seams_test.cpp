// Lines through meshes whose cells share no points where they meet: points of their own, hanging nodes, blocks that
// meet shifted or overlap. The reference is the closed form of u = (-y, x, 0.3).

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
#include "tests/common/trace/linear_fields.h"
#include "tests/support/sample_meshes.h"

namespace palpate {
namespace {

using Field = std::shared_ptr<const VectorField>;

Vec3 helix(const Vec3& x) { return {-x.y, x.x, 0.3}; }
Vec3 on_helix(const Vec3& x, double t) {
  const double c = std::cos(t), s = std::sin(t);
  return {c * x.x - s * x.y, s * x.x + c * x.y, x.z + 0.3 * t};
}

/// Cells of one block, each with points of its own.
class OwnPoints {
 public:
  /// @param noise by which points that coincide differ; @param jump by which the values of each cell do.
  OwnPoints(double noise, double jump) : noise_(noise), jump_(jump) {}

  void add(std::uint8_t type, const std::vector<Vec3>& corners) {
    const Vec3 shift = jump_ * random_vector();
    for (const Vec3& corner : corners) {
      const Vec3 x = corner + noise_ * random_vector(), v = helix(x) + shift;
      topology_.connectivity.push_back(static_cast<std::int64_t>(position_.size() / 3));
      position_.insert(position_.end(), {x.x, x.y, x.z});
      value_.insert(value_.end(), {v.x, v.y, v.z});
    }
    topology_.types.push_back(type);
    topology_.offsets.push_back(static_cast<std::int64_t>(topology_.connectivity.size()));
  }

  /// A box of n cells along each axis, each a hexahedron, or made of six pyramids, two wedges or five tetrahedra.
  void add_box(std::uint8_t type, const Vec3& lower, const Vec3& upper, const Index3& n) {
    for (int k = 0; k < n.z; ++k) {
      for (int j = 0; j < n.y; ++j) {
        for (int i = 0; i < n.x; ++i) {
          const auto at = [&](int a, int b, int c) {
            return lower + (upper - lower) * Vec3(i + a, j + b, k + c) / Vec3(n);
          };
          add_cube(type,
                   {at(0, 0, 0), at(1, 0, 0), at(1, 1, 0), at(0, 1, 0), at(0, 0, 1), at(1, 0, 1), at(1, 1, 1),
                    at(0, 1, 1)},
                   (i + j + k) % 2 != 0);
        }
      }
    }
  }

  [[nodiscard]] DataSet take() const {
    DataSet block;
    UnstructuredTopology topology = topology_;
    topology.positions = make_array("points", Association::kPoint, 3, std::span<const double>(position_));
    block.topology = std::move(topology);
    block.arrays.push_back(make_array("velocity", Association::kPoint, 3, std::span<const double>(value_)));
    return block;
  }

 private:
  void add_cube(std::uint8_t type, const std::array<Vec3, 8>& x, bool odd) {
    if (type == 12) add(12, {x.begin(), x.end()});
    if (type == 13) {
      add(13, {x[0], x[1], x[2], x[4], x[5], x[6]});
      add(13, {x[0], x[2], x[3], x[4], x[6], x[7]});
    }
    if (type == 14) {
      Vec3 middle{0.0};
      for (const Vec3& corner : x) middle += 0.125 * corner;
      for (const auto& f : std::array<std::array<std::size_t, 4>, 6>{
               {{0, 1, 2, 3}, {7, 6, 5, 4}, {0, 4, 5, 1}, {1, 5, 6, 2}, {2, 6, 7, 3}, {3, 7, 4, 0}}})
        add(14, {x[f[0]], x[f[1]], x[f[2]], x[f[3]], middle});
    }
    if (type == 10) {
      using Five = std::array<std::array<std::size_t, 4>, 5>;
      for (const auto& t : odd ? Five{{{1, 0, 2, 5}, {3, 0, 2, 7}, {4, 0, 5, 7}, {6, 2, 5, 7}, {0, 2, 5, 7}}}
                               : Five{{{0, 1, 3, 4}, {2, 1, 3, 6}, {5, 1, 4, 6}, {7, 3, 4, 6}, {1, 3, 4, 6}}})
        add(10, {x[t[0]], x[t[1]], x[t[2]], x[t[3]]});
    }
  }
  Vec3 random_vector() {
    std::uniform_real_distribution<double> one(-1.0, 1.0);
    const double x = one(random_), y = one(random_);
    return {x, y, one(random_)};
  }

  double noise_, jump_;
  std::mt19937_64 random_{7};
  UnstructuredTopology topology_{.positions = {}, .types = {}, .offsets = {0}, .connectivity = {}};
  std::vector<double> position_, value_;
};

Field field_of(const std::vector<DataSet>& blocks) {
  const ArrayInfo info{"velocity", Association::kPoint, 3, ScalarType::kFloat64, 1};
  return make_vector_field(blocks, choose_vector({info}, "velocity", "seams"), "seams");
}

DataSet lattice(const Index3& n, const Vec3& lower, const Vec3& upper, double turn = 0.0) {
  std::vector<Vec3> positions;
  for (int k = 0; k <= n.z; ++k) {
    for (int j = 0; j <= n.y; ++j) {
      for (int i = 0; i <= n.x; ++i) {
        const Vec3 x = lower + (upper - lower) * Vec3(i, j, k) / Vec3(n);
        positions.emplace_back(std::cos(turn) * x.x - std::sin(turn) * x.y,
                               std::sin(turn) * x.x + std::cos(turn) * x.y, x.z);
      }
    }
  }
  return test::structured_block(n + 1, positions, helix);
}

std::vector<Vec3> seeds(int count) {
  std::vector<Vec3> out = test::random_seeds(count, 0.7, 5);
  for (Vec3& x : out) x.z = 0.05 + 0.2 * std::abs(x.z);
  return out;
}

/// Every line follows the helix up to z = 2 or to a side of the box; within `tolerance`, and what it states.
void expect_helices(const Field& field, double tolerance) {
  const std::vector<Vec3> from = seeds(40);
  for (const Integrator integrator : {Integrator::kExact, Integrator::kDp54, Integrator::kRodas4}) {
    SCOPED_TRACE(name_of(integrator));
    TraceOptions options;
    options.integrator = integrator;
    options.tolerance = 1e-9;
    options.threads = 1;
    const TraceResult result = trace_lines(*field, from, options);
    ASSERT_EQ(result.lines.size(), from.size());
    for (const Line& line : result.lines) {
      const LinePoint& last = line.points.back();
      EXPECT_EQ(line.end, End::kLeftDomain) << name_of(line.end) << " seed " << line.seed;
      const double side = std::max(std::abs(last.position.x), std::abs(last.position.y));
      EXPECT_NEAR(std::max(side, last.position.z - 1.0), 1.0, 1e-6) << "seed " << line.seed;
      for (const LinePoint& p : line.points) {
        const double off = glm::distance(p.position, on_helix(from[line.seed], p.time));
        ASSERT_LE(off, tolerance) << "seed " << line.seed << " t " << p.time;
      }
    }
  }
}

bool noted(const Field& field, const std::string& words) {
  for (const std::string& line : field->notes().lines) {
    if (line.find(words) != std::string::npos) return true;
  }
  return false;
}

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

TEST(Seams, LinesCrossBlocksThatMeetShifted) {
  OwnPoints cells(0.0, 0.0);
  cells.add_box(14, {0.1, -1, 0}, {1, 1, 2}, {3, 7, 4});
  expect_helices(field_of({lattice({5, 4, 6}, {-1, -1, 0}, {0.1, 1, 2}), cells.take()}), 1e-6);
  expect_helices(
      field_of({lattice({5, 4, 6}, {-1, -1, 0}, {0.1, 1, 2}), lattice({3, 7, 5}, {0.1, -1, 0}, {1, 1, 2})}),
      1e-6);
}

TEST(Seams, LinesGoOnInTheGridThatOverlaps) {
  const Field field = field_of({lattice({8, 8, 8}, {-1, -1, 0}, {1, 1, 2}),
                                lattice({12, 12, 12}, {-0.4, -0.4, 0.3}, {0.4, 0.4, 1.4}, 0.3)});
  EXPECT_TRUE(noted(field, "where cells overlap"));
  expect_helices(field, 1e-6);
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
