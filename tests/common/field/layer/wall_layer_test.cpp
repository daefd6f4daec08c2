// Layers of a wall, against the potential between two spheres.
#include "common/field/layer/wall_layer.h"

#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/field/field_grid.h"
#include "common/field/layer/wall_border.h"
#include "common/field/layer/wall_surfaces.h"

namespace palpate {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kInside = 1.0, kOutside = 2.0;

/// A part of a spherical shell, `n` cells a side, from `first` to 90 degrees from the pole and `turn` degrees
/// around it. Its cuts are planes and a cone, along which the potential between the spheres has no flux.
DataSet shell(int n, double scale = 1.0, double first = 20.0, double turn = 100.0) {
  DataSet mesh;
  StructuredTopology topology;
  topology.points = Index3{n + 1};
  std::vector<double> positions;
  for (int k = 0; k <= n; ++k) {
    const double r = scale * (kInside + (kOutside - kInside) * k / n);
    for (int j = 0; j <= n; ++j) {
      const double polar = (first + (90.0 - first) * j / n) * kPi / 180.0;
      for (int i = 0; i <= n; ++i) {
        const double around = turn * i / n * kPi / 180.0;
        positions.insert(positions.end(), {r * std::sin(polar) * std::cos(around),
                                           r * std::sin(polar) * std::sin(around), r * std::cos(polar)});
      }
    }
  }
  topology.positions = make_array("points", Association::kPoint, 3, std::span<const double>(positions));
  mesh.topology = topology;
  return mesh;
}

const DataArray& positions_of(const DataSet& mesh) {
  return std::get<StructuredTopology>(mesh.topology).positions;
}

double radius(const DataSet& mesh, std::size_t p) {
  const DataArray& x = positions_of(mesh);
  return std::hypot(x.at(p, 0), x.at(p, 1), x.at(p, 2));
}

void tag(DataSet& mesh, int n) {
  const auto side = static_cast<std::size_t>(n) + 1;
  std::vector<double> tags(side * side * side, 0.0);
  for (std::size_t p = 0; p < side * side; ++p) {
    tags[p] = 1.0;
    tags[tags.size() - 1 - p] = 2.0;
  }
  mesh.arrays.push_back(make_array(kSurfaceArray, Association::kPoint, 1, std::span<const double>(tags)));
}

double worst_error(const DataSet& mesh, const WallLayer& layer) {
  double worst = 0.0;
  for (std::size_t p = 0; p < layer.array.tuples; ++p) {
    const double exact = (1.0 / kInside - 1.0 / radius(mesh, p)) / (1.0 / kInside - 1.0 / kOutside);
    worst = std::max(worst, std::abs(layer.array.at(p) - exact));
  }
  return worst;
}

TEST(WallLayer, ConvergesToThePotentialBetweenSpheresAtSecondOrder) {
  std::vector<double> errors;
  for (const int n : {6, 12, 24}) {
    DataSet mesh = shell(n);
    tag(mesh, n);
    const WallLayer layer = make_wall_layer(mesh, "shell");
    EXPECT_LE(layer.residual, 1e-8);
    errors.push_back(worst_error(mesh, layer));
  }
  EXPECT_LT(errors[2], 0.01);
  EXPECT_GT(std::log2(errors[0] / errors[1]), 1.6);
  EXPECT_GT(std::log2(errors[1] / errors[2]), 1.6);
}

TEST(WallLayer, TheSameForAnyNumberOfThreads) {
  DataSet mesh = shell(16);
  tag(mesh, 16);
  const WallLayer one = make_wall_layer(mesh, "shell", 1), three = make_wall_layer(mesh, "shell", 3);
  EXPECT_GT(one.iterations, 0);
  for (std::size_t p = 0; p < one.array.tuples; ++p) ASSERT_EQ(three.array.at(p), one.array.at(p));
}

TEST(WallLayer, SurfacesAreFoundByTheirCreasesAsWellAsByTags) {
  // A half shell with a pole and a seam, cut flat, as ventricles are at their base.
  const int n = 12;
  const DataSet plain = shell(n, 1.0, 0.0, 360.0);
  DataSet tagged = plain;
  tag(tagged, n);
  const WallLayer found = make_wall_layer(plain, "shell");
  const WallLayer named = make_wall_layer(tagged, "shell");
  for (const char* surface : {": endocardium (area ", ", epicardium (area ", ", base (area 9"})
    EXPECT_NE(found.notes.at(0).find(surface), std::string::npos) << found.notes.at(0);
  for (std::size_t p = 0; p < found.array.tuples; ++p) ASSERT_EQ(found.array.at(p), named.array.at(p)) << p;
  EXPECT_LT(worst_error(plain, found), 0.03);
}

TEST(WallLayer, ScaledDataHaveTheSameLayers) {
  const WallLayer unit = make_wall_layer(shell(6, 1.0, 0.0, 360.0), "shell");
  for (const double scale : {0x1p60, 0x1p-60}) {
    const WallLayer scaled = make_wall_layer(shell(6, scale, 0.0, 360.0), "shell");
    for (std::size_t p = 0; p < unit.array.tuples; ++p) ASSERT_EQ(scaled.array.at(p), unit.array.at(p));
  }
  for (const double scale : {1e30, 1e-30, 1e150, 1e-150}) {
    const WallLayer scaled = make_wall_layer(shell(6, scale, 0.0, 360.0), "shell");
    for (std::size_t p = 0; p < unit.array.tuples; ++p)
      ASSERT_NEAR(scaled.array.at(p), unit.array.at(p), 1e-6);
  }
}

TEST(WallLayer, RisesBetweenZeroAndOne) {
  const WallLayer layer = make_wall_layer(shell(12, 1.0, 0.0, 360.0), "shell");
  for (std::size_t p = 0; p < layer.array.tuples; ++p) {
    EXPECT_GE(layer.array.at(p), 0.0);
    EXPECT_LE(layer.array.at(p), 1.0);
  }
}

TEST(WallLayer, CellsWithoutASayAreCounted) {
  // Point 5 lies nearly on the face 0 1 3 of a proper cell: the cell between them is flat, and 6 lies beyond.
  const std::vector<double> x{0, 0,   0,   1,   0,   0,     0,   1,   0,  0.3, 0,
                              1, 0.4, 0.4, 0.5, 0.4, -1e-5, 0.3, 0.5, -1, 0.3};
  const std::vector<double> tags{1, 1, 1, 2, 0, 0, 0};
  const auto notes_of = [&](std::vector<std::int64_t> corners) {
    UnstructuredTopology topology;
    topology.positions = make_array("x", Association::kPoint, 3, std::span<const double>(x));
    topology.types.assign(corners.size() / 4, 10);
    for (std::size_t c = 0; c <= topology.types.size(); ++c)
      topology.offsets.push_back(static_cast<std::int64_t>(4 * c));
    topology.connectivity = std::move(corners);
    DataSet mesh;
    mesh.topology = std::move(topology);
    mesh.arrays = {make_array(kSurfaceArray, Association::kPoint, 1, std::span<const double>(tags))};
    std::string notes;
    for (const std::string& note : make_wall_layer(mesh, "wedge").notes) notes += note + "\n";
    return notes;
  };
  const char* const counted_text = "1 cell too thin to have a say";
  EXPECT_EQ(notes_of({0, 1, 2, 4, 0, 1, 4, 3, 1, 2, 4, 3, 2, 0, 4, 3}).find("too thin"), std::string::npos);
  const std::string notes =
      notes_of({0, 1, 2, 4, 0, 1, 4, 3, 1, 2, 4, 3, 2, 0, 4, 3, 0, 1, 3, 5, 0, 1, 5, 6});
  EXPECT_NE(notes.find(counted_text), std::string::npos) << notes;
}

TEST(WallLayer, AWallWithoutAnInsideIsRefused) {
  DataSet brick = shell(3);
  std::vector<double> positions;
  for (int p = 0; p < 64; ++p)
    positions.insert(positions.end(), {double(p % 4), double(p / 4 % 4), double(p / 16)});
  std::get<StructuredTopology>(brick.topology).positions =
      make_array("points", Association::kPoint, 3, std::span<const double>(positions));
  try {
    (void)make_wall_layer(brick, "brick.vtk");
    ADD_FAILURE() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::kBadInput);
    EXPECT_NE(std::string(error.what()).find("brick.vtk"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("surface"), std::string::npos);
  }
}

TEST(BorderParts, ABrickHasSixFlatFaces) {
  DataSet brick = shell(3);
  std::vector<double> positions;
  for (int p = 0; p < 64; ++p)
    positions.insert(positions.end(), {double(p % 4), 2.0 * (p / 4 % 4), 3.0 * (p / 16)});
  std::get<StructuredTopology>(brick.topology).positions =
      make_array("points", Association::kPoint, 3, std::span<const double>(positions));
  const auto grid = make_field_grid(std::span(&brick, 1), "brick", 1);
  const auto patches = border_parts(*grid->tets, border_of(*grid->tets), 0.7);
  ASSERT_EQ(patches.size(), 6U);
  Vec3 sum{0.0};
  for (const BorderPart& patch : patches) {
    EXPECT_NEAR(glm::length(patch.normal), 1.0, 1e-12);
    sum += patch.normal * patch.area;
  }
  EXPECT_NEAR(glm::length(sum), 0.0, 1e-12 * patches[0].area) << "the border is closed";
  EXPECT_NEAR(patches[0].area / patches[5].area, 3.0, 1e-12);
}

}  // namespace
}  // namespace palpate
