// Quadratic, Lagrange and Bezier cells: their polynomials, and the meshes that they become.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/field/cells/curved_split.h"
#include "common/field/grid/curved_cell.h"
#include "common/field/grid/tet_mesh.h"
#include "common/field/grid/tet_seams.h"
#include "common/field/vector_field.h"
#include "tests/support/samples.h"

namespace palpate {
namespace {

struct Kind {
  std::uint8_t type;
  std::size_t nodes;
  CurvedCell::Orders orders{};  ///< all zero: by the nodes
};
constexpr std::array<Kind, 20> kKinds{{{24, 10},
                                       {25, 20},
                                       {26, 15},
                                       {27, 13},
                                       {29, 27},
                                       {31, 12},
                                       {32, 18},
                                       {33, 24},
                                       {71, 10},
                                       {71, 20},
                                       {71, 35},
                                       {72, 27},
                                       {72, 64},
                                       {73, 18},
                                       {73, 40},
                                       {73, 75},
                                       {72, 24, {1, 2, 3}},
                                       {72, 60, {2, 3, 4}},
                                       {73, 24, {2, 2, 3}},
                                       {73, 30, {3, 3, 2}}}};

/// Up to the highest order that is read.
constexpr std::array<Kind, 4> kHighOrders{{{71, 165}, {72, 216}, {72, 729}, {73, 405}}};

Vec3 random_inside(std::uint8_t linear, std::mt19937_64& random) {
  std::uniform_real_distribution<double> one(0.0, 1.0);
  for (;;) {
    const double x = one(random), y = one(random), z = one(random);
    if (linear == 10 && x + y + z > 1.0) continue;
    if (linear == 13 && x + y > 1.0) continue;
    if (linear == 14 && std::max(std::abs(x - 0.5), std::abs(y - 0.5)) > 0.5 * (1.0 - z)) continue;
    return {x, y, z};
  }
}

TEST(CurvedCell, PolynomialsOfItsOrderAreItsOwn) {
  std::mt19937_64 random(3);
  std::vector<Kind> kinds(kKinds.begin(), kKinds.end());
  kinds.insert(kinds.end(), kHighOrders.begin(), kHighOrders.end());
  for (const Kind& kind : kinds) {
    SCOPED_TRACE(std::to_string(kind.type) + " of " + std::to_string(kind.nodes));
    const auto cell = CurvedCell::make(kind.type, kind.nodes, kind.orders);
    ASSERT_TRUE(cell);
    ASSERT_EQ(cell->node_count(), kind.nodes);
    const int least = std::ranges::min(kind.orders);
    const int order =
        kind.type == 31 ? 1 : (least > 0 ? least : cell->order());  // 31 is linear along its axis
    const auto f = [order](const Vec3& x) { return std::pow(0.3 + x.x - 0.5 * x.y + 0.25 * x.z, order); };
    std::vector<double> weights;
    for (int n = 0; n < 20; ++n) {
      const Vec3 xi = random_inside(cell->linear_type(), random);
      cell->weights(xi, weights);
      double one = 0.0, sum = 0.0;
      for (std::size_t i = 0; i < weights.size(); ++i) {
        one += weights[i];
        sum += weights[i] * f(cell->nodes()[i]);
      }
      // Equidistant nodes multiply rounding, by some thousand at order 8.
      EXPECT_NEAR(one, 1.0, order > 4 ? 1e-8 : 1e-11);
      EXPECT_NEAR(sum, f(xi), order > 4 ? 1e-8 : 1e-10);
    }
  }
}

TEST(CurvedCell, NodesAreInTheOrderOfVtk) {
  struct Node {
    Kind kind;
    std::size_t index;
    double order;
    Vec3 at;
  };
  // As VTK 9.1 lists them (vtkCell::GetParametricCoords), times the order.
  for (const Node& node : std::vector<Node>{{{71, 35}, 25, 4, {1, 2, 1}},
                                            {{71, 35}, 28, 4, {0, 1, 1}},
                                            {{71, 35}, 32, 4, {1, 2, 0}},
                                            {{73, 40}, 9, 3, {1, 2, 0}},
                                            {{73, 40}, 26, 3, {1, 0, 1}},
                                            {{73, 40}, 34, 3, {0, 2, 1}},
                                            {{73, 40}, 39, 3, {1, 1, 2}},
                                            {{72, 27}, 20, 2, {0, 1, 1}},
                                            {{72, 27}, 23, 2, {1, 2, 1}},
                                            {{25, 20}, 10, 2, {1, 2, 0}},
                                            {{33, 24}, 22, 2, {1, 0, 1}},
                                            {{26, 15}, 14, 2, {0, 2, 1}},
                                            {{24, 10}, 9, 2, {0, 1, 1}},
                                            {{72, 60, {2, 3, 4}}, 10, 12, {12, 8, 0}},
                                            {{72, 60, {2, 3, 4}}, 25, 12, {12, 0, 9}},
                                            {{72, 60, {2, 3, 4}}, 42, 12, {12, 4, 9}},
                                            {{72, 60, {2, 3, 4}}, 53, 12, {6, 8, 12}},
                                            {{72, 60, {2, 3, 4}}, 57, 12, {6, 8, 6}},
                                            {{73, 24, {2, 2, 3}}, 15, 6, {6, 0, 4}},
                                            {{73, 24, {2, 2, 3}}, 21, 6, {3, 3, 4}},
                                            {{73, 30, {3, 3, 2}}, 21, 6, {2, 2, 0}},
                                            {{73, 30, {3, 3, 2}}, 27, 6, {0, 4, 3}}}) {
    const auto cell = CurvedCell::make(node.kind.type, node.kind.nodes, node.kind.orders);
    ASSERT_TRUE(cell);
    EXPECT_LE(glm::distance(node.order * cell->nodes()[node.index], node.at), 1e-12)
        << int{node.kind.type} << " node " << node.index;
  }
}

TEST(CurvedCell, OthersAreNotKnown) {
  EXPECT_FALSE(CurvedCell::make(12, 8));
  EXPECT_FALSE(CurvedCell::make(72, 28));
  EXPECT_FALSE(CurvedCell::make(71, 11));
  EXPECT_FALSE(CurvedCell::make(25, 21));
  EXPECT_FALSE(CurvedCell::make(24, 20));
  EXPECT_FALSE(CurvedCell::make(29, 64));
  EXPECT_FALSE(CurvedCell::make(32, 40));
  EXPECT_FALSE(CurvedCell::make(72, 27, {1, 2, 3}));
  EXPECT_FALSE(CurvedCell::make(73, 24, {2, 3, 2}));
  EXPECT_FALSE(CurvedCell::make(72, 40, {1, 1, 9}));
  EXPECT_FALSE(CurvedCell::make(72, 27, {-1, 2, 2}));
}

using AffineMap = std::pair<Vec3, Mat3>;  ///< origin and three edges

/// The affine maps of a reference cell on to itself that keep its handedness: how else its corners may be numbered.
std::vector<AffineMap> turns_of(const CurvedCell& cell) {
  const std::size_t count = cell.linear_type() == 12   ? 8
                            : cell.linear_type() == 13 ? 6
                            : cell.linear_type() == 14 ? 5
                                                       : 4;
  const std::vector<Vec3> corners(cell.nodes().begin(),
                                  cell.nodes().begin() + static_cast<std::ptrdiff_t>(count));
  const std::size_t last = count == 4 ? 3 : count == 6 ? 3 : 4;  // with 0, 1 and 2 not in a plane
  const Mat3 from(corners[1] - corners[0], corners[2] - corners[0], corners[last] - corners[0]);
  std::vector<AffineMap> turns;
  for (std::size_t n = 0; n < count * count * count * count; ++n) {
    const Vec3 o = corners[n % count], a = corners[n / count % count], b = corners[n / count / count % count],
               c = corners[n / count / count / count];
    const Mat3 edges = Mat3(a - o, b - o, c - o) * glm::inverse(from);
    const Vec3 origin = o - edges * corners[0];
    const bool own = std::ranges::all_of(corners, [&](const Vec3& x) {
      return std::ranges::any_of(corners,
                                 [&](const Vec3& y) { return glm::distance(origin + edges * x, y) < 1e-9; });
    });
    if (own && glm::determinant(edges) > 0.5) turns.emplace_back(origin, edges);
  }
  return turns;
}

/// Cells of one kind that fill the boxes of a lattice of 2 x 2 x 2, with shared nodes; `bend` moves the nodes.
/// @param turned numbers the corners of each cell from a random one.
DataSet cells_of(const Kind& kind, const std::function<Vec3(const Vec3&)>& bend,
                 const std::function<Vec3(const Vec3&)>& value, bool turned = false) {
  std::mt19937_64 random(kind.nodes);
  const auto cell = CurvedCell::make(kind.type, kind.nodes, kind.orders);
  // Each a map of the reference cell into the unit cube: origin and three edges.
  std::vector<AffineMap> maps;
  const std::vector<AffineMap> turns = turns_of(*cell);
  const std::uint8_t linear = cell->linear_type();
  if (linear == 12) maps = {{Vec3(0.0), Mat3(1.0)}};
  if (linear == 13)
    maps = {{Vec3(0, 0, 0), Mat3(Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(0, 0, 1))},
            {Vec3(0, 0, 0), Mat3(Vec3(1, 1, 0), Vec3(0, 1, 0), Vec3(0, 0, 1))}};
  if (linear == 10) {
    for (const auto& o : std::array<std::array<int, 3>, 6>{
             {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}}}) {
      Mat3 edges(0.0);
      for (int s = 0; s < 3; ++s) {
        for (int t = s; t < 3; ++t) edges[t][o[static_cast<std::size_t>(s)]] = 1.0;
      }
      if (glm::determinant(edges) < 0.0) std::swap(edges[1], edges[2]);
      maps.emplace_back(Vec3(0.0), edges);
    }
  }
  if (linear == 14) {
    for (int axis = 0; axis < 3; ++axis) {
      for (const double side : {0.0, 1.0}) {
        // The base on a face, the apex in the middle.
        Mat3 edges(0.0);
        edges[0][(axis + 1) % 3] = 1.0;
        edges[1][(axis + 2) % 3] = 1.0;
        edges[2][axis] = side > 0.0 ? -0.5 : 0.5;
        if (side > 0.0) std::swap(edges[0], edges[1]);
        Vec3 origin(0.0);
        origin[axis] = side;
        maps.emplace_back(origin, edges);
      }
    }
  }
  UnstructuredTopology topology;
  topology.offsets.push_back(0);
  std::vector<double> position, values;
  std::map<std::array<long, 3>, std::int64_t> number;
  for (int c = 0; c < 8; ++c) {
    for (const auto& [origin, edges] : maps) {
      const auto& [shift, turn] = turns[turned ? random() % turns.size() : 0];
      for (const Vec3& xi : cell->nodes()) {
        const Vec3 reference = turned ? shift + turn * xi : xi;
        const Vec3 x = Vec3(c & 1, c >> 1 & 1, c >> 2) + origin + edges * reference;
        const std::array<long, 3> key{std::lround(1e4 * x.x), std::lround(1e4 * x.y), std::lround(1e4 * x.z)};
        const auto [found, fresh] = number.try_emplace(key, static_cast<std::int64_t>(number.size()));
        if (fresh) {
          const Vec3 y = bend(x), v = value(y);
          position.insert(position.end(), {y.x, y.y, y.z});
          values.insert(values.end(), {v.x, v.y, v.z});
        }
        topology.connectivity.push_back(found->second);
      }
      topology.types.push_back(kind.type);
      topology.offsets.push_back(static_cast<std::int64_t>(topology.connectivity.size()));
    }
  }
  topology.positions = make_array("points", Association::kPoint, 3, std::span<const double>(position));
  std::vector<double> degrees;
  for (std::size_t c = 0; c < topology.types.size(); ++c)
    degrees.insert(degrees.end(), kind.orders.begin(), kind.orders.end());
  DataSet block;
  block.topology = std::move(topology);
  block.arrays.push_back(make_array("velocity", Association::kPoint, 3, std::span<const double>(values)));
  if (kind.orders != CurvedCell::Orders{})
    block.arrays.push_back(
        make_array(kHigherOrderDegrees, Association::kCell, 3, std::span<const double>(degrees)));
  return block;
}

std::shared_ptr<const VectorField> field_of(const DataSet& block) {
  const ArrayInfo info{"velocity", Association::kPoint, 3, ScalarType::kFloat64, 1};
  return make_vector_field({block}, choose_vector({info}, "velocity", "curved"), "curved");
}

Vec3 bent(const Vec3& x) {
  return x + 0.04 * Vec3(x.y * x.y - x.z, x.z * x.z + x.x * x.y, x.x * x.x - x.y * x.z);
}

// However their corners are numbered.
TEST(CurvedCells, AreOneMeshAndLinearFieldsAreExact) {
  const auto helix = [](const Vec3& x) { return Vec3(-x.y, x.x, 0.3); };
  std::mt19937_64 random(5);
  for (std::size_t n = 0; n < 2 * kKinds.size(); ++n) {
    const Kind& kind = kKinds[n / 2];
    const bool turned = n % 2 == 1;
    if (turned && kind.orders != CurvedCell::Orders{}) continue;  // neighbours would not have the same nodes
    SCOPED_TRACE(std::to_string(kind.type) + " of " + std::to_string(kind.nodes) +
                 (turned ? ", turned" : ""));
    const auto field = field_of(cells_of(kind, bent, helix, turned));
    for (const std::string& line : field->notes().lines) {
      EXPECT_EQ(line.find("inside out"), std::string::npos) << line;
      EXPECT_EQ(line.find("overlap"), std::string::npos) << line;
      EXPECT_EQ(line.find("corners alone"), std::string::npos) << line;
    }
    EXPECT_EQ(field->notes().inverted_cells, 0U);
    EXPECT_EQ(find_seams(*field->tet_mesh(), 1).faces, 0U);
    std::uniform_real_distribution<double> one(0.1, 1.9);
    CellHint hint;
    for (int n = 0; n < test::samples_of(50); ++n) {
      const double x = one(random), y = one(random);
      const Vec3 at = bent({x, y, one(random)});
      const VectorSample sample = field->sample(at, hint);
      ASSERT_EQ(sample.status, SampleStatus::kOk) << n;
      EXPECT_LE(glm::distance(sample.value, helix(at)), 1e-9);
    }
  }
}

TEST(CurvedCells, OrdersThatAreNoneLeaveTheCorners) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const Kind& kind =
      *std::ranges::find_if(kKinds, [](const Kind& k) { return k.orders != CurvedCell::Orders{}; });
  const auto straight = [](const Vec3& x) { return x; };
  const DataSet right = cells_of(kind, straight, straight);
  for (const double more : {std::nan(""), -10.0, 0.5, 1e300, kInfinity}) {
    std::vector<double> degrees;
    for (std::size_t i = 0; i < right.arrays.back().tuples * 3; ++i)
      degrees.push_back(kind.orders[i % 3] + (i < 3 ? more : 0.0));
    DataSet block = right;
    block.arrays.back() =
        make_array(kHigherOrderDegrees, Association::kCell, 3, std::span<const double>(degrees));
    const auto field = field_of(block);
    const bool said = std::ranges::any_of(field->notes().lines, [](const std::string& line) {
      return line.find("1 higher-order cell taken through their corners alone") != std::string::npos;
    });
    EXPECT_TRUE(said) << more;
    CellHint hint;
    EXPECT_EQ(field->sample({0.4, 0.3, 0.6}, hint).status, SampleStatus::kOk) << more;
  }
}

TEST(CurvedCells, ValuesAreThoseOfThePolynomialWithinTheStatedError) {
  const auto parabola = [](const Vec3& x) {
    // A large part without curvature keeps the number of parts small.
    return Vec3(11.0 - (x.y - 1.0) * (x.y - 1.0), 0.0, 0.2 * x.x * x.z);
  };
  const auto straight = [](const Vec3& x) { return x; };
  std::mt19937_64 random(5);
  for (const Kind& kind : kKinds) {
    if (kind.type == 31) continue;  // linear along its axis
    SCOPED_TRACE(std::to_string(kind.type) + " of " + std::to_string(kind.nodes));
    const DataSet block = cells_of(kind, straight, parabola);
    const PointValue value = [](const DataSet& data, std::size_t p) {
      return Vec3(data.arrays.front().at(p, 0), data.arrays.front().at(p, 1), data.arrays.front().at(p, 2));
    };
    const auto split = split_curved({&block, 1}, value);
    ASSERT_TRUE(split);
    // Some diagonals fit into the finer lattice alone, and count there.
    EXPECT_LE(split->made.error, 3.0 * kCurvedError);
    EXPECT_GE(split->parts, 2);
    const auto field = field_of(block);
    EXPECT_NEAR(field->max_speed(), std::hypot(11.0, 0.4), 0.05);
    std::uniform_real_distribution<double> one(0.05, 1.95);
    CellHint hint;
    double most = 0.0;
    for (int n = 0; n < test::samples_of(200); ++n) {
      const double x = one(random), y = one(random);
      const Vec3 at{x, y, one(random)};
      const VectorSample sample = field->sample(at, hint);
      ASSERT_EQ(sample.status, SampleStatus::kOk) << n;
      most = std::max(most, glm::distance(sample.value, parabola(at)));
    }
    EXPECT_LE(most, split->made.error * std::hypot(11.0, 0.8) + 1e-9);
  }
}

// Where a cell bends, a value that is linear in its parameters is not so in space.
TEST(CurvedCells, StatedErrorsIncludeThoseOfBentCells) {
  const auto cell = CurvedCell::make(72, 27);
  std::vector<double> position, values;
  UnstructuredTopology topology{.positions = {}, .types = {72}, .offsets = {0, 27}, .connectivity = {}};
  const auto place = [](const Vec3& xi) {
    return Vec3(xi.x + 0.6 * xi.x * xi.x, xi.y + 0.3 * xi.x * xi.x, xi.z);
  };
  for (const Vec3& xi : cell->nodes()) {
    const Vec3 x = place(xi);
    topology.connectivity.push_back(static_cast<std::int64_t>(topology.connectivity.size()));
    position.insert(position.end(), {x.x, x.y, x.z});
    values.insert(values.end(), {xi.x, 0.5 * xi.y, 0.0});
  }
  topology.positions = make_array("points", Association::kPoint, 3, std::span<const double>(position));
  DataSet block;
  block.topology = std::move(topology);
  block.arrays.push_back(make_array("velocity", Association::kPoint, 3, std::span<const double>(values)));
  const PointValue value = [](const DataSet& data, std::size_t p) {
    return Vec3(data.arrays.front().at(p, 0), data.arrays.front().at(p, 1), 0.0);
  };
  const auto split = split_curved({&block, 1}, value);
  ASSERT_TRUE(split);
  const auto field = field_of(block);
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> one(0.02, 0.98);
  CellHint hint;
  double most = 0.0;
  for (int n = 0; n < test::samples_of(400); ++n) {
    const double x = one(random), y = one(random);
    const Vec3 xi{x, y, one(random)};
    const VectorSample sample = field->sample(place(xi), hint);
    ASSERT_EQ(sample.status, SampleStatus::kOk) << n;
    most = std::max(most, glm::distance(sample.value, Vec3(xi.x, 0.5 * xi.y, 0.0)));
  }
  EXPECT_GT(most, 1e-5);
  EXPECT_LE(most, split->made.error * std::hypot(1.0, 0.5) + 1e-12);
  EXPECT_LE(split->made.error, 10.0 * most);
}

TEST(CurvedCells, OneCellAcrossAChannelHasItsParabola) {
  // The corners are all on the walls: through them alone the field would be zero.
  const auto profile = [](const Vec3& x) { return Vec3(x.y * (2.0 - x.y), 0.0, 0.0); };
  const auto stretched = [](const Vec3& x) { return Vec3(x.x, 2.0 * (x.y > 1.0 ? 1.0 : x.y), x.z); };
  const auto cell = CurvedCell::make(72, 27);
  UnstructuredTopology topology{.positions = {}, .types = {72}, .offsets = {0, 27}, .connectivity = {}};
  std::vector<double> position, values;
  for (const Vec3& xi : cell->nodes()) {
    const Vec3 x = stretched(xi), v = profile(x);
    topology.connectivity.push_back(static_cast<std::int64_t>(topology.connectivity.size()));
    position.insert(position.end(), {x.x, x.y, x.z});
    values.insert(values.end(), {v.x, v.y, v.z});
  }
  topology.positions = make_array("points", Association::kPoint, 3, std::span<const double>(position));
  DataSet block;
  block.topology = std::move(topology);
  block.arrays.push_back(make_array("velocity", Association::kPoint, 3, std::span<const double>(values)));
  const auto field = field_of(block);
  EXPECT_NEAR(field->max_speed(), 1.0, 1e-12);
  CellHint hint;
  for (double y = 0.05; y < 2.0; y += 0.1)
    EXPECT_NEAR(field->sample({0.4, y, 0.6}, hint).value.x, y * (2.0 - y), 2e-3);
}

}  // namespace
}  // namespace palpate
