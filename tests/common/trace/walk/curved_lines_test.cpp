// Lines through curved cells: what their linear parts are off by counts into the errors of lines. The reference is the
// closed form of the flow along a channel, u = 1 - y^2.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "common/field/grid/curved_cell.h"
#include "common/field/vector_field.h"
#include "common/trace/trace.h"

namespace palpate {
namespace {

constexpr std::uint8_t kLagrange = 72, kBezier = 79;

/// Three cells of 27 nodes in a row over [-1, 2] x [-1, 1] x [0, 1].
/// @param value at a node; of Bezier cells at a control point.
std::shared_ptr<const VectorField> channel(const std::function<Vec3(const Vec3&)>& value,
                                           std::uint8_t type = kLagrange) {
  const auto cell = CurvedCell::make(72, 27);
  UnstructuredTopology topology{.positions = {}, .types = {}, .offsets = {0}, .connectivity = {}};
  std::vector<double> position, values;
  for (int part = 0; part < 3; ++part) {
    for (const Vec3& xi : cell->nodes()) {
      const Vec3 x{xi.x + part - 1.0, 2.0 * xi.y - 1.0, xi.z}, v = value(x);
      topology.connectivity.push_back(static_cast<std::int64_t>(topology.connectivity.size()));
      position.insert(position.end(), {x.x, x.y, x.z});
      values.insert(values.end(), {v.x, v.y, v.z});
    }
    topology.types.push_back(type);
    topology.offsets.push_back(static_cast<std::int64_t>(topology.connectivity.size()));
  }
  topology.positions = make_array("points", Association::kPoint, 3, std::span<const double>(position));
  DataSet block;
  block.topology = std::move(topology);
  block.arrays.push_back(make_array("velocity", Association::kPoint, 3, std::span<const double>(values)));
  const ArrayInfo info{"velocity", Association::kPoint, 3, ScalarType::kFloat64, 1};
  return make_vector_field({block}, choose_vector({info}, "velocity", "channel"), "channel");
}

void expect_channel(const VectorField& field) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> one(-0.9, 0.9);
  std::vector<Vec3> from;
  for (int seed = 0; seed < 20; ++seed) {
    const double y = one(random);
    from.emplace_back(0.5 + 1.5 * one(random), y, 0.5 + 0.5 * one(random));
  }
  for (const Integrator integrator : {Integrator::kExact, Integrator::kDp54}) {
    TraceOptions options;
    options.integrator = integrator;
    options.threads = 1;
    double most = 0.0;
    for (const Line& line : trace_lines(field, from, options).lines) {
      EXPECT_EQ(line.end, End::kLeftDomain) << name_of(line.end);
      const Vec3& seed = from[line.seed];
      for (const LinePoint& point : line.points) {
        const Vec3 due = seed + Vec3((1.0 - seed.y * seed.y) * point.time, 0.0, 0.0);
        const double off = glm::distance(point.position, due);
        most = std::max(most, off);
        EXPECT_LE(off, point.error) << "seed " << line.seed;
        EXPECT_LT(point.error, 0.1);
      }
    }
    EXPECT_GT(most, 1e-6);  // there is something to be stated
  }
}

TEST(CurvedLines, ErrorsIncludeWhatLinearPartsAreOff) {
  expect_channel(*channel([](const Vec3& x) { return Vec3(1.0 - x.y * x.y, 0.0, 0.0); }));
}

// The control point in the middle has twice the speed that the cell has there.
TEST(CurvedLines, ErrorsOfBezierCellsAreThoseOfTheirValuesNotOfTheirControlPoints) {
  expect_channel(*channel([](const Vec3& x) { return Vec3(x.y == 0.0 ? 2.0 : 0.0, 0.0, 0.0); }, kBezier));
}

TEST(CurvedLines, LinearFieldsAreAsExactAsInLinearCells) {
  const auto field = channel([](const Vec3& x) { return Vec3(1.0 + 0.1 * x.x, 0.2 * x.y, 0.0); });
  const std::vector<Vec3> from{{-0.9, 0.1, 0.4}, {0.2, -0.3, 0.7}};
  for (const Line& line : trace_lines(*field, from, {}).lines) {
    for (const LinePoint& point : line.points) EXPECT_LT(point.error, 1e-10);
  }
}

}  // namespace
}  // namespace palpate
