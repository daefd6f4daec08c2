// Directions that are given to cells: left constant in each, or recovered to the points.
#include <array>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <numbers>
#include <random>
#include <span>

#include <gtest/gtest.h>

#include "common/field/analytic/ventricle.h"
#include "common/field/field_grid.h"
#include "common/field/grid/tet_mesh.h"
#include "common/field/heart/fibre_angles.h"
#include "common/field/heart/heart.h"
#include "common/math/symmetric3.h"

namespace palpate {
namespace {

/// The ventricle's mesh with the fibre at the middle of each cell in place of those at points.
DataSet ventricle_of_cells(const VentricleCells& cells, const std::vector<double>& signs = {}) {
  const Ventricle shape;
  DataSet mesh = ventricle_mesh(shape, cells);
  const auto& topology = std::get<UnstructuredTopology>(mesh.topology);
  std::vector<double> fibres;
  for (std::size_t c = 0; c < topology.types.size(); ++c) {
    Vec3 middle{0.0};
    for (auto n = topology.offsets[c]; n < topology.offsets[c + 1]; ++n) {
      const auto p = static_cast<std::size_t>(topology.connectivity[static_cast<std::size_t>(n)]);
      for (int axis = 0; axis < 3; ++axis) middle[axis] += topology.positions.at(p, axis);
    }
    middle /= static_cast<double>(topology.offsets[c + 1] - topology.offsets[c]);
    const Vec3 fibre =
        (signs.empty() ? 1.0 : signs[c % signs.size()]) * shape.fibre(shape.coordinates(middle));
    fibres.insert(fibres.end(), {fibre.x, fibre.y, fibre.z});
  }
  std::erase_if(mesh.arrays, [](const DataArray& array) { return array.name != "layer"; });
  mesh.arrays.push_back(make_array("fibre", Association::kCell, 3, std::span<const double>(fibres)));
  return mesh;
}

Heart heart_of(const DataSet& mesh, bool constant) {
  HeartChoice choice{.fibre = {"fibre", Association::kCell}, .layer = "layer"};
  choice.constant_cells = constant;
  return make_heart(mesh, choice, "cells");
}

/// In the middle of the wall, off the apex and the base: over two whole cells of four, so that all parts of a
/// cell have their say.
Prolate random_place(std::mt19937& random) {
  std::uniform_real_distribution<double> wall(0.575, 0.725), along(0.9, 1.6), around(-3.1, 3.1);
  return {wall(random), along(random), around(random)};
}

TEST(CellDirections, ConstantOnesAreThoseOfTheCellAllOverIt) {
  const DataSet mesh = ventricle_of_cells({.wall = 3, .along = 12, .around = 20});
  const DataArray& given = *mesh.find("fibre", Association::kCell);
  const Heart heart = heart_of(mesh, true);
  EXPECT_TRUE(heart.fibres->constant_in_cells());
  const FieldGrid& grid = *heart.fibres->grid();
  std::mt19937 random(5);
  std::uniform_real_distribution<double> part(0.05, 1.0);
  for (std::size_t t = 0; t < grid.tets->cells().size(); ++t) {
    if (grid.tets->zero_volume(static_cast<CellIndex>(t))) continue;
    std::array<TensorSample, 3> samples{};
    for (TensorSample& sample : samples) {
      Vec4 b{part(random), part(random), part(random), part(random)};
      b /= b[0] + b[1] + b[2] + b[3];
      Vec3 x{0.0};
      for (int n = 0; n < 4; ++n)
        x += b[n] * grid.tets->points()[grid.tets->cells()[t][static_cast<std::size_t>(n)]];
      CellHint hint{static_cast<CellIndex>(t)};
      sample = heart.fibres->sample(heart.layer->frame().data_from_local(x), hint);
      ASSERT_EQ(sample.status, SampleStatus::kOk);
    }
    EXPECT_TRUE(samples[0].value == samples[1].value);
    EXPECT_TRUE(samples[0].value == samples[2].value);
    const std::size_t cell = grid.source_cell[t];
    const Vec3 fibre{given.at(cell, 0), given.at(cell, 1), given.at(cell, 2)};
    EXPECT_NEAR(std::abs(glm::dot(fibre, symmetric_eigen(samples[0].value).vectors[0])), 1.0, 1e-12);
  }
  // Maps of points have the mean of the cells around, either way.
  const auto a = std::get<std::span<const double>>(heart.fibres->values());
  const Heart recovered = heart_of(mesh, false);
  EXPECT_FALSE(recovered.fibres->constant_in_cells());
  const auto b = std::get<std::span<const double>>(recovered.fibres->values());
  ASSERT_EQ(a.size(), b.size());
  EXPECT_EQ(std::memcmp(a.data(), b.data(), a.size_bytes()), 0);
}

/// Root mean square of the angle to the ventricle's own fibre [degrees].
double direction_error(const VentricleCells& cells, bool constant) {
  const Ventricle shape;
  const Heart heart = heart_of(ventricle_of_cells(cells), constant);
  std::mt19937 random(7);
  double sum = 0.0;
  constexpr int kPlaces = 2000;
  CellHint hint;
  for (int i = 0; i < kPlaces; ++i) {
    const Prolate at = random_place(random);
    const TensorSample sample = heart.fibres->sample(shape.position(at), hint);
    EXPECT_EQ(sample.status, SampleStatus::kOk);
    const Vec3 along = symmetric_eigen(sample.value).vectors[0];
    const double angle = std::atan2(glm::length(glm::cross(along, shape.fibre(at))),
                                    std::abs(glm::dot(along, shape.fibre(at))));
    sum += angle * angle;
  }
  return std::sqrt(sum / kPlaces) * 180.0 / std::numbers::pi;
}

// Fibres turn through the wall and around it: a constant is off by the cell's size, the mean at points by its
// square.
TEST(CellDirections, RecoveredOnesConvergeAnOrderFaster) {
  const VentricleCells coarse{.wall = 4, .along = 16, .around = 32},
      fine{.wall = 8, .along = 32, .around = 64};
  const double constant = direction_error(coarse, true), constant_fine = direction_error(fine, true);
  const double recovered = direction_error(coarse, false), recovered_fine = direction_error(fine, false);
  EXPECT_NEAR(std::log2(constant / constant_fine), 1.0, 0.1) << constant << " -> " << constant_fine;
  EXPECT_GT(std::log2(recovered / recovered_fine), 1.8) << recovered << " -> " << recovered_fine;
  EXPECT_LT(recovered_fine, constant_fine / 4.0);
}

TEST(CellDirections, RandomSignsChangeNoBitEitherWay) {
  const VentricleCells cells{.wall = 2, .along = 8, .around = 16};
  std::mt19937 random(3);
  std::vector<double> signs(257);
  for (double& sign : signs) sign = (random() & 1U) != 0 ? -1.0 : 1.0;
  for (const bool constant : {true, false}) {
    const Heart before = heart_of(ventricle_of_cells(cells), constant);
    const Heart after = heart_of(ventricle_of_cells(cells, signs), constant);
    for (int i = 0; i < 500; ++i) {
      const Vec3 x = Ventricle().position(random_place(random));
      CellHint one, other;
      const TensorSample a = before.fibres->sample(x, one), b = after.fibres->sample(x, other);
      ASSERT_EQ(a.status, SampleStatus::kOk);
      ASSERT_TRUE(a.value == b.value);
    }
    const auto a = map_gap(before), b = map_gap(after);
    EXPECT_EQ(std::memcmp(a.data(), b.data(), a.size() * sizeof(double)), 0);
  }
}

/// The ventricle's mesh, all fibres along x, but for those of cells that `missing` names.
DataSet straight_but(const VentricleCells& cells, const std::function<bool(std::size_t)>& missing,
                     double instead) {
  DataSet mesh = ventricle_of_cells(cells);
  std::vector<double> fibres;
  for (std::size_t c = 0; c < mesh.cell_count(); ++c) {
    if (missing(c)) {
      fibres.insert(fibres.end(), {instead, instead, instead});
    } else {
      fibres.insert(fibres.end(), {1.0, 0.0, 0.0});
    }
  }
  std::erase_if(mesh.arrays, [](const DataArray& array) { return array.name == "fibre"; });
  mesh.arrays.push_back(make_array("fibre", Association::kCell, 3, std::span<const double>(fibres)));
  return mesh;
}

// Zero, NaN and infinite numbers are no direction. A point has the mean of the cells around that have one.
TEST(CellDirections, CellsWithoutOneTakeNoneFromTheirNeighbours) {
  const VentricleCells cells{.wall = 2, .along = 8, .around = 16};
  std::mt19937 random(19);
  std::vector<bool> chosen(straight_but(
                               cells, [](std::size_t) { return false; }, 0.0)
                               .cell_count());
  for (std::size_t c = 0; c < chosen.size(); ++c) chosen[c] = random() % 10 == 0;
  const std::size_t half = chosen.size() / 2;
  const std::vector<std::function<bool(std::size_t)>> kinds{
      [&](std::size_t c) { return bool(chosen[c]); },  // one in ten
      [&](std::size_t c) { return c == half; },        // a single one
      [&](std::size_t c) { return c >= half; }};       // a region, such as a bath
  for (const auto& missing : kinds) {
    for (const double instead : {0.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
      const DataSet mesh = straight_but(cells, missing, instead);
      const Heart heart = heart_of(mesh, false);
      const FieldGrid& grid = *heart.fibres->grid();
      std::vector<bool> has(grid.point_count()), used(grid.point_count());
      for (std::size_t t = 0; t < grid.tets->cells().size(); ++t)
        for (const std::uint32_t p : grid.tets->cells()[t]) {
          used[p] = true;
          if (!missing(grid.source_cell[t])) has[p] = true;
        }
      const auto values = std::get<std::span<const double>>(heart.fibres->values());
      for (std::size_t p = 0; p < has.size(); ++p) {
        if (!used[p]) continue;
        if (!has[p]) {
          EXPECT_TRUE(std::isnan(values[6 * p])) << p;
          continue;
        }
        ASSERT_NEAR(values[6 * p], 1.0, 1e-12) << p;
        for (std::size_t i = 1; i < 6; ++i) ASSERT_NEAR(values[6 * p + i], 0.0, 1e-12) << p;
      }
      std::string notes;
      for (const std::string& note : heart.notes) notes += note + "\n";
      EXPECT_NE(notes.find("without a direction: left out"), std::string::npos) << notes;
    }
  }
}

}  // namespace
}  // namespace palpate
