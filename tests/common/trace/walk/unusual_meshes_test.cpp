// Lines of linear fields through meshes that a generator of good ones would not make: flat cells in the way,
// and cells of every shape split at diagonals of a random order. The reference is the matrix exponential.

#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/trace/trace.h"
#include "tests/common/trace/linear_fields.h"
#include "tests/support/sample_meshes.h"

namespace palpate {
namespace {

using Field = std::shared_ptr<const VectorField>;
using test::rows;

constexpr int kPoints = 5;  // along each axis

/// Two slabs of cubes that meet at z = 0, each cube of five tetrahedra. The slabs cut the squares between
/// them by different diagonals, and a tetrahedron of no height joins the two halves of each: the mesh is
/// conforming only through them.
Field on_slabs(const Mat3& a, const Vec3& c) {
  std::vector<double> position, value;
  UnstructuredTopology topology;
  for (int k = 0; k < kPoints; ++k) {
    for (int j = 0; j < kPoints; ++j) {
      for (int i = 0; i < kPoints; ++i) {
        const Vec3 x{-1.0 + 0.5 * i, -1.0 + 0.5 * j, -1.0 + 0.5 * k};
        const Vec3 v = a * (x - c);
        position.insert(position.end(), {x.x, x.y, x.z});
        value.insert(value.end(), {v.x, v.y, v.z});
      }
    }
  }
  const auto point = [](int i, int j, int k) {
    return static_cast<std::int64_t>(i + kPoints * (j + kPoints * k));
  };
  topology.offsets.push_back(0);
  const auto add = [&topology](const std::array<std::int64_t, 4>& tet) {
    topology.connectivity.insert(topology.connectivity.end(), tet.begin(), tet.end());
    topology.offsets.push_back(static_cast<std::int64_t>(topology.connectivity.size()));
    topology.types.push_back(10);
  };
  constexpr std::array<std::array<int, 4>, 5> kFive{
      {{0, 1, 2, 4}, {3, 1, 2, 7}, {5, 1, 4, 7}, {6, 2, 4, 7}, {1, 2, 4, 7}}};
  constexpr int kMiddle = kPoints / 2;
  for (int k = 0; k + 1 < kPoints; ++k) {
    for (int j = 0; j + 1 < kPoints; ++j) {
      for (int i = 0; i + 1 < kPoints; ++i) {
        const int flip = (i + j + k + (k >= kMiddle ? 1 : 0)) % 2;
        for (const auto& five : kFive) {
          std::array<std::int64_t, 4> tet{};
          for (std::size_t n = 0; n < 4; ++n) {
            tet[n] = point(i + ((five[n] & 1) ^ flip), j + (five[n] >> 1 & 1), k + (five[n] >> 2 & 1));
          }
          add(tet);
        }
        if (k == kMiddle)
          add({point(i, j, k), point(i + 1, j, k), point(i + 1, j + 1, k), point(i, j + 1, k)});
      }
    }
  }
  topology.positions = make_array("points", Association::kPoint, 3, std::span<const double>(position));
  DataSet block;
  block.topology = topology;
  block.arrays.push_back(make_array("velocity", Association::kPoint, 3, std::span<const double>(value)));
  const ArrayInfo info{"velocity", Association::kPoint, 3, ScalarType::kFloat64, value.size() / 3};
  return make_vector_field({block}, choose_vector({info}, "velocity", "slabs"), "slabs");
}

/// Expects lines that follow the exact curve to 1e-9 of the diagonal, with time and arc that only grow.
void expect_exact(const TraceResult& result, const Mat3& a, const Vec3& c, const std::vector<Vec3>& seeds,
                  double diagonal) {
  for (const Line& line : result.lines) {
    for (std::size_t i = 0; i < line.points.size(); ++i) {
      const LinePoint& p = line.points[i];
      ASSERT_LE(glm::distance(p.position, test::exact_line(a, c, seeds[line.seed], p.time)), 1e-9 * diagonal)
          << "seed " << line.seed << " point " << i;
      if (i == 0) continue;
      ASSERT_GE(p.time, line.points[i - 1].time);
      ASSERT_GE(p.arc, line.points[i - 1].arc);
    }
  }
}

TraceResult traced(const Field& field, const std::vector<Vec3>& seeds, Integrator integrator) {
  TraceOptions options;
  options.integrator = integrator;
  options.tolerance = 1e-10;
  options.threads = 1;
  return trace_lines(*field, seeds, options);
}

TEST(UnusualMeshes, LinesPassThroughFlatCells) {
  const Vec3 c{0.0625, 0.03125, -1.5};
  for (const Mat3& a : {rows(0, -2, 0, 2, 0, 0, 0, 0, 1), rows(-0.5, 0, 0, 0, -0.25, 0.5, 0, 0, 0.5)}) {
    const Field field = on_slabs(a, c);
    ASSERT_EQ(field->notes().zero_volume_cells, 16U);
    std::vector<Vec3> seeds = test::random_seeds(60, 0.6, 3);
    for (Vec3& x : seeds) x.z = -0.9;
    // Straight at vertices and edges of the flat cells where the second flow goes nowhere else.
    seeds.push_back({c.x, c.y, -0.9});
    for (const Integrator integrator : {Integrator::kExact, Integrator::kDp54, Integrator::kRodas4}) {
      SCOPED_TRACE(name_of(integrator));
      const TraceResult result = traced(field, seeds, integrator);
      ASSERT_EQ(result.lines.size(), seeds.size());
      std::size_t passed = 0;
      for (const Line& line : result.lines) {
        EXPECT_EQ(line.end, End::kLeftDomain) << name_of(line.end) << " seed " << line.seed;
        const Vec3 x = glm::abs(line.points.back().position);
        EXPECT_NEAR(std::max(x.x, std::max(x.y, x.z)), 1.0, 1e-9) << "seed " << line.seed;
        passed += line.points.back().position.z > 0.0 ? 1 : 0;
      }
      EXPECT_GT(passed, 40U);
      expect_exact(result, a, c, seeds, field->diagonal());
    }
  }
}

TEST(UnusualMeshes, LinesPassThroughEdgesAndVerticesOfFlatCells) {
  const Field field = on_slabs(rows(0, 0, 0, 0, 0, 0, 0, 0, 0.25), {0, 0, -3});
  std::vector<Vec3> seeds;
  for (int i = 0; i <= 8; ++i) {
    for (int j = 0; j <= 8; ++j) seeds.push_back({-1.0 + 0.25 * i, -1.0 + 0.25 * j, -0.75});
  }
  for (const Integrator integrator : {Integrator::kExact, Integrator::kDp54}) {
    for (const Line& line : traced(field, seeds, integrator).lines) {
      EXPECT_EQ(line.end, End::kLeftDomain)
          << name_of(integrator) << " " << name_of(line.end) << " seed " << line.seed;
      const Vec3 end{seeds[line.seed].x, seeds[line.seed].y, 1.0};
      EXPECT_LE(glm::distance(line.points.back().position, end), 1e-9)
          << name_of(integrator) << " seed " << line.seed;
    }
  }
}

TEST(UnusualMeshes, CellsSplitInARandomOrderGiveTheExactLines) {
  const Mat3 a = rows(0.5, -3, 0, 3, 0.25, 1, 0, 0.5, -0.5);
  const Vec3 c{0.4, 0.55, 0.3};
  std::vector<Vec3> seeds = test::random_seeds(40, 0.45, 9);
  for (Vec3& x : seeds) x += 0.5;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const DataSet block = test::mixed_cells(5, 0.15, seed, [&](const Vec3& x) { return a * (x - c); });
    const ArrayInfo info{"velocity", Association::kPoint, 3, ScalarType::kFloat64, block.arrays[0].tuples};
    const Field field = make_vector_field({block}, choose_vector({info}, "velocity", "mixed"), "mixed");
    for (const Integrator integrator : {Integrator::kExact, Integrator::kDp54}) {
      SCOPED_TRACE(std::string(name_of(integrator)) + " numbering " + std::to_string(seed));
      const TraceResult result = traced(field, seeds, integrator);
      ASSERT_EQ(result.lines.size(), seeds.size());
      expect_exact(result, a, c, seeds, field->diagonal());
      for (const Line& line : result.lines) EXPECT_EQ(line.end, End::kLeftDomain) << name_of(line.end);
    }
  }
}

}  // namespace
}  // namespace palpate
