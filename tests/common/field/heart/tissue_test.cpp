// Which elements of a heart's mesh are muscle, and what is said of those that are not; whether a depth that comes along
// rises outwards.
#include "common/field/heart/tissue.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include "common/field/field_grid.h"
#include "common/field/heart/heart.h"
#include "common/field/layer/wall_surfaces.h"
#include "tests/support/zone_mesh.h"

namespace palpate {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

Heart heart_of(const DataSet& mesh) {
  std::vector<ArrayInfo> arrays;
  for (const DataArray& a : mesh.arrays)
    arrays.push_back({a.name, a.association, a.components, a.type, a.tuples});
  return make_heart(mesh, choose_heart(arrays, "", "shell"), "shell");
}

std::string notes_of_heart(const DataSet& mesh) {
  std::string notes;
  for (const std::string& note : heart_of(mesh).notes) notes += note + "\n";
  return notes;
}

/// A shell whose fibres go round; in `depth` of the wall it is muscle, with region 1, elsewhere not.
DataSet shell_in_bath(double inner, double outer, double from, double to, bool of_points, const char* name) {
  const test::ZoneCells cells{.wall = 12, .along = 12, .around = 24};
  DataSet mesh = test::zone_mesh(
      [&](double s, double t, double angle) {
        return test::on_sphere(inner + (outer - inner) * s, t * 100.0 * kDegree, angle);
      },
      cells, true);
  const auto& topology = std::get<UnstructuredTopology>(mesh.topology);
  const auto at = [&](std::int64_t p) {
    const auto i = static_cast<std::size_t>(p);
    return Vec3{topology.positions.at(i, 0), topology.positions.at(i, 1), topology.positions.at(i, 2)};
  };
  const auto fibre_at = [](const Vec3& x) { return Vec3{-x.y, x.x, 0.0}; };
  constexpr double kRounding = 1e-9;
  std::vector<double> fibres, regions;
  for (std::size_t c = 0; c < topology.types.size(); ++c) {
    Vec3 middle{0.0};
    double radius = 0.0;
    const auto corners = static_cast<double>(topology.offsets[c + 1] - topology.offsets[c]);
    for (auto i = topology.offsets[c]; i < topology.offsets[c + 1]; ++i) {
      const Vec3 x = at(topology.connectivity[static_cast<std::size_t>(i)]);
      middle += x / corners;
      radius += glm::length(x) / corners;
    }
    const bool muscle = radius > from && radius < to;
    regions.push_back(muscle ? 1.0 : radius < from ? 2.0 : 3.0);
    // Some elements of muscle have lost theirs.
    const Vec3 fibre = muscle && c % 10 != 3 ? fibre_at(middle) : Vec3{0.0};
    if (!of_points) fibres.insert(fibres.end(), {fibre.x, fibre.y, fibre.z});
  }
  for (std::size_t p = 0; of_points && p < mesh.point_count(); ++p) {
    const Vec3 x = at(static_cast<std::int64_t>(p));
    const double r = glm::length(x);
    const Vec3 fibre = r > from - kRounding && r < to + kRounding ? fibre_at(x) : Vec3{0.0};
    fibres.insert(fibres.end(), {fibre.x, fibre.y, fibre.z});
  }
  mesh.arrays.push_back(make_array("fibre", of_points ? Association::kPoint : Association::kCell, 3,
                                   std::span<const double>(fibres)));
  mesh.arrays.push_back(make_array(name, Association::kCell, 1, std::span<const double>(regions)));
  return mesh;
}

// Bath outside and blood inside: depth of the potential of a shell, (1/a - 1/r) / (1/a - 1/b).
TEST(Tissue, LayersAreWhereFibresAre) {
  for (const bool of_points : {false, true}) {
    for (const auto& [inner, outer] : {std::pair{20.0, 44.0}, std::pair{8.0, 32.0}, std::pair{14.0, 38.0}}) {
      const double from = 20.0, to = inner == 8.0 ? 32.0 : 30.0;
      const Heart heart = heart_of(shell_in_bath(inner, outer, from, to, of_points, "region"));
      const bool blood = inner < from;
      EXPECT_EQ(heart.regions_left_out.front(), blood ? 2.0 : 3.0);
      std::string notes;
      for (const std::string& note : heart.notes) notes += note + "\n";
      EXPECT_NE(notes.find(blood ? "region 2" : "region 3"), std::string::npos) << notes;
      EXPECT_EQ(notes.find("WARNING"), std::string::npos) << notes;
      CellHint hint;
      double worst = 0.0;
      for (int i = 1; i < 20; ++i) {
        const double r = from + (to - from) * i / 20.0;
        const ScalarSample depth = heart.layer->sample(test::on_sphere(r, 0.9, 0.07 * i), hint);
        ASSERT_EQ(depth.status, SampleStatus::kOk) << r;
        worst = std::max(worst, std::abs(depth.value - (1.0 / from - 1.0 / r) / (1.0 / from - 1.0 / to)));
      }
      EXPECT_LT(worst, 0.03) << of_points << " " << inner << "\n" << notes;
      for (const double r : {inner + 1.0, outer - 1.0}) {
        const bool muscle = r > from && r < to;
        const SampleStatus status = heart.fibres->sample(test::on_sphere(r, 0.9, 0.3), hint).status;
        EXPECT_EQ(status == SampleStatus::kOk, muscle) << r;
      }
    }
  }
  // Without regions nothing tells, and that is said.
  DataSet untold = shell_in_bath(20.0, 44.0, 20.0, 30.0, false, "potential");
  std::string notes;
  for (const std::string& note : heart_of(untold).notes) notes += note + "\n";
  EXPECT_NE(notes.find("WARNING"), std::string::npos) << notes;
  EXPECT_NE(notes.find("without a fibre"), std::string::npos) << notes;
}

// Programs that take no zeros give bath and blood a direction all the same: one for all of it.
TEST(Tissue, ARegionOfOneDirectionIsDoubted) {
  const DataSet mesh = shell_in_bath(20.0, 44.0, 20.0, 30.0, false, "region");
  const auto with = [&mesh](double turn) {
    DataSet filled = mesh;
    DataArray& fibre = filled.arrays.front();
    const DataArray& region = filled.arrays.back();
    std::vector<double> values;
    for (std::size_t c = 0; c < fibre.tuples; ++c) {
      const double angle = turn * static_cast<double>(c);
      for (int axis = 0; axis < 3; ++axis)
        values.push_back(region.at(c) == 1.0 ? fibre.at(c, axis)
                         : axis == 0         ? std::cos(angle)
                         : axis == 1         ? std::sin(angle)
                                             : 0.0);
    }
    fibre = make_array("fibre", Association::kCell, 3, std::span<const double>(values));
    return notes_of_heart(filled);
  };
  const std::string even = with(0.0);
  EXPECT_NE(even.find("of region 3 are (1, 0, 0)"), std::string::npos) << even;
  EXPECT_EQ(even.find("region 1 are"), std::string::npos) << even;
  EXPECT_EQ(with(0.01).find("WARNING"), std::string::npos);
}

// Gmsh and others write the border's triangles beside the cells, numbered, and without fibres.
TEST(Tissue, TrianglesOfTheBorderAreNoRegion) {
  DataSet mesh = shell_in_bath(20.0, 30.0, 20.0, 30.0, false, "region");
  auto& cells = std::get<UnstructuredTopology>(mesh.topology);
  std::vector<double> regions, fibres;
  for (std::size_t c = 0; c < cells.types.size(); ++c) {
    regions.push_back(mesh.arrays[1].at(c));
    for (int axis = 0; axis < 3; ++axis) fibres.push_back(mesh.arrays[0].at(c, axis));
  }
  const std::size_t volumes = cells.types.size();
  for (std::size_t t = 0; t < volumes; ++t) {
    constexpr std::uint8_t kTriangle = 5;
    const auto first = cells.connectivity.begin() + cells.offsets[t];
    const std::array<std::int64_t, 3> corners{first[0], first[1], first[2]};
    cells.connectivity.insert(cells.connectivity.end(), corners.begin(), corners.end());
    cells.offsets.push_back(static_cast<std::int64_t>(cells.connectivity.size()));
    cells.types.push_back(kTriangle);
    regions.push_back(9.0);
    fibres.insert(fibres.end(), {0.0, 0.0, 0.0});
  }
  for (const bool numbered : {true, false}) {
    mesh.arrays = {
        make_array("fibre", Association::kCell, 3, std::span<const double>(fibres)),
        make_array(numbered ? "region" : "other", Association::kCell, 1, std::span<const double>(regions))};
    const std::string notes = notes_of_heart(mesh);
    EXPECT_EQ(notes.find("as it has no fibres"), std::string::npos) << notes;
    EXPECT_EQ(notes.find("WARNING"), std::string::npos) << notes;
    EXPECT_NE(notes.find("without a volume left out"), std::string::npos) << notes;
  }
}

TEST(Tissue, ADepthThatRisesInwardsIsSaid) {
  for (const bool inwards : {false, true}) {
    DataSet mesh = shell_in_bath(20.0, 30.0, 20.0, 30.0, false, "region");
    const auto& topology = std::get<UnstructuredTopology>(mesh.topology);
    std::vector<double> depth;
    for (std::size_t p = 0; p < mesh.point_count(); ++p) {
      const double outwards = 0.1 * (std::hypot(topology.positions.at(p, 0), topology.positions.at(p, 1),
                                                topology.positions.at(p, 2)) -
                                     20.0);
      depth.push_back(inwards ? 1.0 - outwards : outwards);
    }
    mesh.arrays.push_back(make_array(kLayerArray, Association::kPoint, 1, std::span<const double>(depth)));
    const std::string notes = notes_of_heart(mesh);
    EXPECT_NE(notes.find("layers from the array"), std::string::npos) << notes;
    EXPECT_EQ(notes.find("rises inwards") != std::string::npos, inwards) << notes;
  }
}

}  // namespace
}  // namespace palpate
