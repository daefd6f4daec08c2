// Values of cells brought to the points: exact for linear fields, in range at jumps, honest about the difference.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/field/cells/cell_fit.h"
#include "common/field/grid/tet_mesh.h"
#include "common/field/vector_field.h"

namespace palpate {
namespace {

using Field = std::shared_ptr<const VectorField>;
using Value = Vec3 (*)(const Vec3&);

Vec3 linear(const Vec3& x) {
  return {1.0 + x.x - 2.0 * x.y + 0.5 * x.z, 3.0 * x.z - x.x, x.y + 0.25 * x.x - 7.0};
}

Field field_of(DataSet block, const std::vector<double>& values) {
  block.arrays = {make_array("velocity", Association::kCell, 3, std::span<const double>(values))};
  const VectorChoice choice{VectorChoice::Kind::kArray, Association::kCell, {"velocity"}, "velocity"};
  return make_vector_field({block}, choice, "cells");
}

/// The largest difference in the note, as a part of the largest value.
double noted_difference(const Field& field) {
  constexpr std::string_view kWords = "differ from their values by up to ";
  for (const std::string& line : field->notes().lines) {
    const std::size_t at = line.find(kWords);
    if (at != std::string::npos) return 0.01 * std::stod(line.substr(at + kWords.size()));
  }
  return -1.0;
}

bool noted_one_layer(const Field& field) {
  return std::ranges::any_of(field->notes().lines, [](const std::string& line) {
    return line.find("in one layer alone") != std::string::npos;
  });
}

std::vector<double> graded(int cells, double growth) {
  std::vector<double> x{0.0};
  for (int i = 0; i < cells; ++i) x.push_back(x.back() + std::pow(growth, i));
  for (double& v : x) v /= x.back();
  return x;
}

/// A rectilinear block with the field's values at the centres of its cells.
Field on_boxes(const std::array<std::vector<double>, 3>& x, Value value,
               const std::vector<std::uint8_t>& hidden = {}) {
  std::vector<double> values;
  for (std::size_t k = 0; k + 1 < x[2].size(); ++k) {
    for (std::size_t j = 0; j + 1 < x[1].size(); ++j) {
      for (std::size_t i = 0; i + 1 < x[0].size(); ++i) {
        const Vec3 v = value(0.5 * Vec3(x[0][i] + x[0][i + 1], x[1][j] + x[1][j + 1], x[2][k] + x[2][k + 1]));
        values.insert(values.end(), {v.x, v.y, v.z});
      }
    }
  }
  DataSet block;
  block.topology = RectilinearTopology{x};
  block.hidden_cells = hidden;
  return field_of(block, values);
}

/// Cubes with moved corners, in [0, 1]^3, as five tetrahedra each, or as hexahedra: those are parallelepipeds where
/// the corners move by a linear map, so that centres are means of corners.
struct Mesh {
  DataSet block;
  std::vector<Vec3> centres;
};
Mesh mesh_of(std::uint8_t type, const Index3& n, double jitter, double stretch) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> one(-jitter, jitter);
  std::vector<Vec3> points;
  for (int k = 0; k <= n.z; ++k) {
    for (int j = 0; j <= n.y; ++j) {
      for (int i = 0; i <= n.x; ++i) {
        Vec3 x = Vec3(i, j, k);
        if (type == 10) {
          const double a = one(random), b = one(random), c = one(random);
          x += Vec3(a, b, c);
        }
        x /= Vec3(n);
        points.push_back({x.x + 0.3 * x.y, x.y - 0.2 * x.z, stretch * (x.z + 0.1 * x.x)});
      }
    }
  }
  const auto at = [&](int i, int j, int k) { return i + (n.x + 1) * (j + (n.y + 1) * k); };
  UnstructuredTopology topology{.positions = {}, .types = {}, .offsets = {0}, .connectivity = {}};
  Mesh out;
  const auto add = [&](std::uint8_t t, const std::vector<int>& corners) {
    Vec3 sum{0.0};
    for (const int p : corners) {
      topology.connectivity.push_back(p);
      sum += points[static_cast<std::size_t>(p)];
    }
    out.centres.push_back(sum / static_cast<double>(corners.size()));
    topology.types.push_back(t);
    topology.offsets.push_back(static_cast<std::int64_t>(topology.connectivity.size()));
  };
  for (int k = 0; k < n.z; ++k) {
    for (int j = 0; j < n.y; ++j) {
      for (int i = 0; i < n.x; ++i) {
        const std::array<int, 8> c{
            at(i, j, k),     at(i + 1, j, k),     at(i + 1, j + 1, k),     at(i, j + 1, k),
            at(i, j, k + 1), at(i + 1, j, k + 1), at(i + 1, j + 1, k + 1), at(i, j + 1, k + 1)};
        if (type == 12) {
          add(12, {c.begin(), c.end()});
          continue;
        }
        using Five = std::array<std::array<std::size_t, 4>, 5>;
        const Five odd{{{1, 0, 2, 5}, {3, 0, 2, 7}, {4, 0, 5, 7}, {6, 2, 5, 7}, {0, 2, 5, 7}}};
        const Five even{{{0, 1, 3, 4}, {2, 1, 3, 6}, {5, 1, 4, 6}, {7, 3, 4, 6}, {1, 3, 4, 6}}};
        for (const auto& t : (i + j + k) % 2 != 0 ? odd : even) add(10, {c[t[0]], c[t[1]], c[t[2]], c[t[3]]});
      }
    }
  }
  std::vector<double> position;
  for (const Vec3& x : points) position.insert(position.end(), {x.x, x.y, x.z});
  topology.positions = make_array("points", Association::kPoint, 3, std::span<const double>(position));
  out.block.topology = std::move(topology);
  return out;
}

std::vector<double> values_at(const std::vector<Vec3>& centres, Value value) {
  std::vector<double> out;
  for (const Vec3& x : centres) {
    const Vec3 v = value(x);
    out.insert(out.end(), {v.x, v.y, v.z});
  }
  return out;
}

TEST(CellValues, LinearFieldsAreExactOnGradedBoxes) {
  for (const double growth : {1.0, 1.5, 4.0}) {
    const Field field = on_boxes({graded(7, growth), graded(5, 1.0), graded(6, 1.0 / growth)}, linear);
    EXPECT_LT(noted_difference(field), 1e-13);
    EXPECT_FALSE(noted_one_layer(field));
    CellHint hint;
    for (const double x : {0.0, 1e-6, 0.013, 0.2, 0.5, 0.97, 1.0}) {
      for (const double y : {0.0, 0.4, 1.0}) {
        for (const double z : {0.0, 0.3, 0.999, 1.0}) {
          const Vec3 at{x, y, z};
          EXPECT_LT(glm::distance(field->sample(at, hint).value, linear(at)), 1e-12) << growth;
        }
      }
    }
  }
}

TEST(CellValues, LinearFieldsAreExactOnCellsOfAnyShape) {
  for (const std::uint8_t type : {10, 12}) {
    for (const double stretch : {1.0, 1e-4, 1e3}) {
      SCOPED_TRACE(int{type});
      const Mesh mesh = mesh_of(type, {5, 4, 6}, 0.2, stretch);
      const Field field = field_of(mesh.block, values_at(mesh.centres, linear));
      EXPECT_FALSE(noted_one_layer(field));
      const TetMesh& tets = *field->tet_mesh();
      CellHint hint;
      double most = 0.0;
      for (std::size_t t = 0; t < tets.cells().size(); ++t) {
        // Near each corner, those at the border, too.
        for (int i = 0; i < 4; ++i) {
          Vec4 b(1e-3);
          b[i] = 1.0 - 3e-3;
          const Vec3 x = field->frame().data_from_local(tets.position(static_cast<CellIndex>(t), b));
          const VectorSample sample = field->sample(x, hint);
          if (sample.status != SampleStatus::kOk) continue;
          most = std::max(most, glm::distance(sample.value, linear(x)) / (1.0 + glm::length(linear(x))));
        }
      }
      EXPECT_LT(most, 1e-10) << stretch;
    }
  }
}

TEST(CellValues, JumpsMakeNoNewExtrema) {
  const Value step = [](const Vec3& x) { return Vec3(x.x > 0.5 ? 1.0 : 0.0, x.y > 0.3 ? -2.0 : 5.0, 0.0); };
  CellHint hint;
  const Field box = on_boxes({graded(8, 1.2), graded(9, 1.0), graded(6, 0.8)}, step);
  const Mesh mesh = mesh_of(10, {6, 6, 6}, 0.2, 1.0);
  const Field tets = field_of(mesh.block, values_at(mesh.centres, step));
  std::mt19937_64 random(8);
  std::uniform_real_distribution<double> one(0.0, 1.0);
  int inside = 0;
  for (int n = 0; n < 5000; ++n) {
    const double a = one(random), b = one(random);
    const Vec3 x{a, b, one(random)};
    for (const Field& field : {box, tets}) {
      const VectorSample sample = field->sample(x, hint);
      if (sample.status != SampleStatus::kOk) continue;
      ++inside;
      // At a border of tetrahedra a jump beside the point leaves some slope towards it.
      const double slack = field == tets ? 0.05 : 1e-11;
      EXPECT_GE(sample.value.x, -slack);
      EXPECT_LE(sample.value.x, 1.0 + slack);
      EXPECT_GE(sample.value.y, -2.0 - 7.0 * slack);
      EXPECT_LE(sample.value.y, 5.0 + 7.0 * slack);
    }
  }
  EXPECT_GT(inside, 7000);
}

TEST(CellValues, OneLayerIsSaid) {
  const Value flat = [](const Vec3& x) { return Vec3(x.y, 1.0 - x.x, 0.0); };
  const Field box = on_boxes({graded(5, 1.3), graded(4, 1.0), {0.0, 0.01}}, flat);
  EXPECT_TRUE(noted_one_layer(box));
  EXPECT_LT(noted_difference(box), 1e-13);
  CellHint hint;
  EXPECT_LT(glm::distance(box->sample({0.0, 1.0, 0.01}, hint).value, Vec3(1.0, 1.0, 0.0)), 1e-12);
  const Mesh mesh = mesh_of(12, {5, 5, 1}, 0.0, 0.01);
  const Field tets = field_of(mesh.block, values_at(mesh.centres, flat));
  EXPECT_TRUE(noted_one_layer(tets));
  // A single cell has its value.
  const Field single = on_boxes({std::vector<double>{0, 1}, {0, 1}, {0, 1}}, linear);
  EXPECT_TRUE(noted_one_layer(single));
  EXPECT_LT(glm::distance(single->sample({0.2, 0.9, 0.4}, hint).value, linear(Vec3(0.5))), 1e-12);
}

/// Turned about an oblique axis: a layer of cells lies in no plane of coordinates.
const Mat3 kTurn = [] {
  const Vec3 a = glm::normalize(Vec3(1.0, 0.4, -0.3)), b = glm::normalize(glm::cross(a, Vec3(0.2, 1.0, 0.5)));
  return Mat3(a, b, glm::cross(a, b));
}();

Vec3 turning_in_layer(const Vec3& x) {
  const Vec3 at = glm::transpose(kTurn) * x;  // its third component does not matter
  return kTurn * Vec3(0.2 - at.y, at.x + 0.5 * at.y, 1.0 + 2.0 * at.x);
}

Vec3 along_strip(const Vec3& x) {
  return kTurn * Vec3(2.0 - glm::dot(kTurn[0], x), 0.5, glm::dot(kTurn[0], x));
}

/// `n` hexahedra (12), or twice as many wedges (13), on
/// [0, 1]^2 with the thickness given, turned; sheared within the layer, if it is more than a strip.
Mesh layer_of(std::uint8_t type, const Index3& n, double thickness) {
  Mesh out;
  std::vector<double> position;
  std::vector<Vec3> points;
  for (int k = 0; k <= n.z; ++k) {
    for (int j = 0; j <= n.y; ++j) {
      for (int i = 0; i <= n.x; ++i) {
        const Vec3 x = Vec3(i, j, k) / Vec3(n);
        points.push_back(kTurn * Vec3(x.x + (n.y > 1 ? 0.3 * x.y : 0.0), x.y, thickness * x.z));
        position.insert(position.end(), {points.back().x, points.back().y, points.back().z});
      }
    }
  }
  UnstructuredTopology mesh{
      .positions = make_array("points", Association::kPoint, 3, std::span<const double>(position)),
      .types = {},
      .offsets = {0},
      .connectivity = {}};
  const std::vector<std::vector<int>> parts =
      type == 12 ? std::vector<std::vector<int>>{{0, 1, 3, 2, 4, 5, 7, 6}}
                 : std::vector<std::vector<int>>{{0, 1, 3, 4, 5, 7}, {0, 3, 2, 4, 7, 6}};
  for (int k = 0; k < n.z; ++k) {
    for (int j = 0; j < n.y; ++j) {
      for (int i = 0; i < n.x; ++i) {
        for (const std::vector<int>& part : parts) {
          Vec3 sum{0.0};
          for (const int c : part) {
            mesh.connectivity.push_back(i + (c & 1) +
                                        (n.x + 1) * (j + (c >> 1 & 1) + (n.y + 1) * (k + (c >> 2))));
            sum += points[static_cast<std::size_t>(mesh.connectivity.back())];
          }
          mesh.types.push_back(type);
          mesh.offsets.push_back(static_cast<std::int64_t>(mesh.connectivity.size()));
          out.centres.push_back(sum / static_cast<double>(part.size()));
        }
      }
    }
  }
  out.block.topology = std::move(mesh);
  return out;
}

TEST(CellValues, FieldsWithoutAChangeAcrossOneLayerAreExact) {
  struct Case {
    Index3 n;
    Value value;
  };
  for (const std::uint8_t type : {std::uint8_t{12}, std::uint8_t{13}}) {
    for (const double thickness : {1e-3, 0.05, 0.5, 2.0}) {
      for (const Case& c : {Case{{8, 7, 1}, turning_in_layer}, Case{{8, 1, 1}, along_strip},
                            Case{{8, 7, 2}, turning_in_layer}}) {
        if (type == 13 && c.n.y == 1) continue;  // centres of wedges are in two rows
        const Mesh mesh = layer_of(type, c.n, thickness);
        const Field field = field_of(mesh.block, values_at(mesh.centres, c.value));
        double worst = 0.0;
        int found = 0;
        CellHint hint;
        for (const double x : {0.0, 0.03, 0.31, 0.5, 0.98, 1.0}) {
          for (const double y : {0.0, 0.02, 0.44, 1.0}) {
            for (const double z : {0.0, 0.2, 0.5, 1.0}) {
              const Vec3 within = 1e-9 + (1.0 - 2e-9) * Vec3(x, y, z);
              const Vec3 at =
                  kTurn * Vec3(within.x + (c.n.y > 1 ? 0.3 * within.y : 0.0), within.y, thickness * within.z);
              const VectorSample sample = field->sample(at, hint);
              ASSERT_EQ(sample.status, SampleStatus::kOk);
              worst = std::max(worst, glm::distance(sample.value, c.value(at)));
              ++found;
            }
          }
        }
        EXPECT_EQ(found, 96);
        EXPECT_LT(worst, 1e-11) << static_cast<int>(type) << " " << thickness << " " << c.n.y << " " << c.n.z;
      }
    }
  }
}

TEST(CellValues, TheDifferenceIsThatOfTheMeansOverCells) {
  // u = x^2 by its means over ten cells of width 0.1: at inner points x^2 + h^2 / 3, at the ends, by the line through
  // two means, h^2 / 3 - h^2 / 2 ... ; over a cell the field is linear.
  constexpr double kH = 0.1;
  std::vector<double> x, values;
  for (int i = 0; i <= 10; ++i) x.push_back(kH * i);
  for (int n = 0; n < 10 * 2 * 2; ++n) {
    const double a = kH * (n % 10), b = a + kH;
    values.insert(values.end(), {(a * a + a * b + b * b) / 3.0, 0.0, 0.0});
  }
  DataSet block;
  block.topology = RectilinearTopology{{x, std::vector<double>{0, 1, 2}, {0, 1, 2}}};
  const Field field = field_of(block, values);
  CellHint hint;
  EXPECT_NEAR(field->sample({0.5, 1.0, 1.0}, hint).value.x, 0.25 + kH * kH / 3.0, 1e-12);
  EXPECT_GT(noted_difference(field), 0.0);
  // Inside: the mean of x^2 + h^2 / 3 at both ends exceeds the mean of x^2 by h^2 / 3 + h^2 / 6.
  const double largest = (0.81 + 0.9 + 1.0) / 3.0;
  EXPECT_GE(noted_difference(field), 0.49 * kH * kH / largest);
  EXPECT_LE(noted_difference(field), 3.0 * kH * kH / largest);
}

TEST(CellValues, WallsAndHolesStayWhatTheyAre) {
  // A hidden layer across the flow: what is behind it tells nothing of this side.
  std::vector<std::uint8_t> hidden(8 * 4 * 4, 0);
  for (std::size_t n = 0; n < hidden.size(); ++n) hidden[n] = n % 8 == 4 ? 1 : 0;
  const Value two_sides = [](const Vec3& x) { return Vec3(x.x < 0.5 ? x.x : 100.0, 1.0, 0.0); };
  const Field field = on_boxes({graded(8, 1.0), graded(4, 1.0), graded(4, 1.0)}, two_sides, hidden);
  CellHint hint;
  EXPECT_NEAR(field->sample({0.499999, 0.5, 0.5}, hint).value.x, 0.5, 1e-5);
  EXPECT_NEAR(field->sample({0.625001, 0.5, 0.5}, hint).value.x, 100.0, 1e-9);
  EXPECT_EQ(field->sample({0.55, 0.5, 0.5}, hint).status, SampleStatus::kBadData);

  // A cell without a value makes bad data of the cells that touch it, of no others.
  const Value hole = [](const Vec3& x) {
    const bool here = x.x > 0.5 && x.x < 0.625 && x.y > 0.25 && x.y < 0.5 && x.z > 0.25 && x.z < 0.5;
    return here ? Vec3(std::numeric_limits<double>::quiet_NaN()) : linear(x);
  };
  const Field holed = on_boxes({graded(8, 1.0), graded(4, 1.0), graded(4, 1.0)}, hole);
  EXPECT_EQ(holed->notes().bad_values, 8U);
  EXPECT_EQ(holed->sample({0.55, 0.3, 0.3}, hint).status, SampleStatus::kBadData);
  const Vec3 corner{0.99, 0.99, 0.01};
  EXPECT_LT(glm::distance(holed->sample(corner, hint).value, linear(corner)), 1e-12);
}

TEST(CellFit, ExtrapolatesNoFartherThanALine) {
  // Two cells in a row, the point on the far side of the first: 1.5 v0 - 0.5 v1.
  CellFit fit;
  const std::vector<Vec3> centres{{0.5, 0, 0}, {1.5, 0, 0},  {0.5, 1, 0},
                                  {0.5, 0, 1}, {0.5, -1, 0}, {0.5, 0, -1}};
  fit.set(centres, 1, Mat3(1.0));
  EXPECT_FALSE(fit.flat());
  const std::vector<double> values{2.0, 3.0, 2.0, 2.0, 2.0, 2.0};
  EXPECT_NEAR(fit.value(values, 1), 1.5, 1e-12);
  const std::vector<double> even(6, 4.0);
  EXPECT_DOUBLE_EQ(fit.value(even, 1), 4.0);
}

}  // namespace
}  // namespace palpate
