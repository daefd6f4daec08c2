// Rational Bezier cells are exact on conics: a quarter of a pipe and of a rod, in which the flow turns about the axis.
// u = (-y, x, 0.3) in closed form: the values of control points are those of their places, since u is linear.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/field/cells/curved_split.h"
#include "common/field/grid/curved_cell.h"
#include "common/field/vector_field.h"
#include "common/trace/trace.h"

namespace palpate {
namespace {

constexpr std::uint8_t kBezierHexahedron = 79, kBezierWedge = 80;

struct Control {
  Vec3 at{0.0};
  double weight = 1.0;
};

/// One cell over [0, 1] along z. `control` at the parameters of a node, all three.
template <typename Place>
DataSet cell_of(std::uint8_t type, std::size_t nodes, const CurvedCell::Orders& orders,
                const Place& control) {
  const auto cell = CurvedCell::make(type, nodes, orders);
  UnstructuredTopology topology{
      .positions = {}, .types = {type}, .offsets = {0, static_cast<std::int64_t>(nodes)}, .connectivity = {}};
  std::vector<double> position, values, weights;
  for (const Vec3& xi : cell->nodes()) {
    const Control c = control(xi);
    topology.connectivity.push_back(static_cast<std::int64_t>(topology.connectivity.size()));
    position.insert(position.end(), {c.at.x, c.at.y, c.at.z});
    values.insert(values.end(), {-c.at.y, c.at.x, 0.3});
    weights.push_back(c.weight);
  }
  topology.positions = make_array("points", Association::kPoint, 3, std::span<const double>(position));
  std::vector<double> degrees(orders.begin(), orders.end());
  DataSet block;
  block.topology = std::move(topology);
  block.arrays.push_back(make_array("velocity", Association::kPoint, 3, std::span<const double>(values)));
  block.arrays.push_back(
      make_array(kRationalWeights, Association::kPoint, 1, std::span<const double>(weights)));
  if (orders != CurvedCell::Orders{})
    block.arrays.push_back(
        make_array(kHigherOrderDegrees, Association::kCell, 3, std::span<const double>(degrees)));
  return block;
}

/// Of the arc of radius 1 from (1, 0) to (0, 1), at 0, 1/2 and 1.
Control on_arc(double xi) {
  if (xi == 0.5) return {{1.0, 1.0, 0.0}, std::numbers::sqrt2 / 2.0};
  return {xi < 0.5 ? Vec3(1.0, 0.0, 0.0) : Vec3(0.0, 1.0, 0.0), 1.0};
}

/// Radii 1 to 2, the angle first.
DataSet quarter_of_pipe(std::size_t nodes, const CurvedCell::Orders& orders) {
  return cell_of(kBezierHexahedron, nodes, orders, [](const Vec3& xi) {
    Control c = on_arc(xi.x);
    c.at = (2.0 - xi.y) * c.at + Vec3(0.0, 0.0, xi.z);
    return c;
  });
}

/// Radii 0 to 1: the first corner of the triangles is on the axis.
DataSet quarter_of_rod(std::size_t nodes, const CurvedCell::Orders& orders) {
  return cell_of(kBezierWedge, nodes, orders, [](const Vec3& xi) {
    Control c{{xi.x, xi.y, 0.0}, 1.0};
    if (xi.x == 0.5 && xi.y == 0.5) c = on_arc(0.5);
    c.at.z = xi.z;
    return c;
  });
}

std::shared_ptr<const VectorField> field_of(const DataSet& block) {
  const ArrayInfo info{"velocity", Association::kPoint, 3, ScalarType::kFloat64, 1};
  return make_vector_field({block}, choose_vector({info}, "velocity", "rational"), "rational");
}

Vec3 velocity_of(const DataSet& block, std::size_t p) {
  const DataArray& array = block.arrays.front();
  return {array.at(p, 0), array.at(p, 1), array.at(p, 2)};
}

struct Case {
  std::string name;
  DataSet block;
  double inner, outer;  ///< radii
};
std::vector<Case> cases() {
  return {{"pipe", quarter_of_pipe(12, {2, 1, 1}), 1.0, 2.0},
          {"pipe of order 2", quarter_of_pipe(27, {}), 1.0, 2.0},
          {"rod", quarter_of_rod(12, {2, 2, 1}), 0.0, 1.0},
          {"rod of order 2", quarter_of_rod(18, {}), 0.0, 1.0}};
}

TEST(RationalCells, TheirBordersAreArcs) {
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.name);
    const auto split = split_curved({&c.block, 1}, velocity_of);
    ASSERT_TRUE(split);
    EXPECT_EQ(split->unweighted, 0U);
    const auto& mesh = std::get<UnstructuredTopology>(split->blocks.front().topology);
    // The middle control points lie outside; no part has them.
    std::size_t on_outer = 0;
    for (const std::int64_t p : mesh.connectivity) {
      const auto point = static_cast<std::size_t>(p);
      const double r = std::hypot(mesh.positions.at(point, 0), mesh.positions.at(point, 1));
      EXPECT_LE(r, c.outer * (1.0 + 1e-14));
      EXPECT_GE(r, c.inner * (1.0 - 1e-14));
      on_outer += std::abs(r - c.outer) < 1e-14 * c.outer ? 1 : 0;
    }
    EXPECT_GE(on_outer, 8U);
  }
}

TEST(RationalCells, LinesTurnAboutTheAxis) {
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.name);
    const auto field = field_of(c.block);
    for (const std::string& line : field->notes().lines)
      EXPECT_EQ(line.find("weights"), std::string::npos) << line;
    std::vector<Vec3> seeds;
    for (const double part : {0.2, 0.5, 0.8}) {
      const double r = c.inner + part * (c.outer - c.inner);
      seeds.emplace_back(r * std::cos(0.1), r * std::sin(0.1), 0.2);
    }
    TraceOptions options;
    options.threads = 1;
    const auto traced = trace_lines(*field, seeds, options);
    ASSERT_EQ(traced.lines.size(), seeds.size());
    for (const Line& line : traced.lines) {
      const Vec3& seed = seeds[line.seed];
      EXPECT_EQ(line.end, End::kLeftDomain);
      EXPECT_NEAR(line.points.back().time, std::numbers::pi / 2.0 - 0.1, 1e-9);
      for (const LinePoint& point : line.points) {
        const double angle = 0.1 + point.time, r = std::hypot(seed.x, seed.y);
        EXPECT_LE(glm::distance(point.position,
                                Vec3(r * std::cos(angle), r * std::sin(angle), 0.2 + 0.3 * point.time)),
                  1e-9);
      }
    }
  }
}

TEST(RationalCells, WeightsThatAreNoneAreCounted) {
  DataSet block = quarter_of_pipe(27, {});
  std::vector<double> weights(27, 1.0);
  weights[5] = -1.0;
  block.arrays.back() =
      make_array(kRationalWeights, Association::kPoint, 1, std::span<const double>(weights));
  EXPECT_EQ(split_curved({&block, 1}, velocity_of)->odd_weights, 1U);
  const auto noted = field_of(block);
  EXPECT_TRUE(std::ranges::any_of(noted->notes().lines, [](const std::string& line) {
    return line.find("1 Bezier cell has rational weights that are not above 0") == 0;
  }));
  block.arrays.pop_back();
  EXPECT_EQ(split_curved({&block, 1}, velocity_of)->unweighted, 1U);
}

}  // namespace
}  // namespace palpate
