// Fibres, layers and angles of a heart, against the ventricle whose formulas are known.
#include "common/field/heart/heart.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>
#include <random>
#include <span>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/field/analytic/ventricle.h"
#include "common/field/field_grid.h"
#include "common/field/grid/tet_mesh.h"
#include "common/field/heart/fibre_angles.h"
#include "common/field/heart/wall_frame.h"
#include "common/math/symmetric3.h"

namespace palpate {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

std::vector<ArrayInfo> arrays_of(const DataSet& mesh) {
  std::vector<ArrayInfo> arrays;
  for (const DataArray& a : mesh.arrays)
    arrays.push_back({a.name, a.association, a.components, a.type, a.tuples});
  return arrays;
}

Heart heart_of(const DataSet& mesh) {
  return make_heart(mesh, choose_heart(arrays_of(mesh), "", "shell"), "shell");
}

/// Where the shell is: within `margin` of neither surface, apex nor base.
class RandomPlaces {
 public:
  explicit RandomPlaces(const Ventricle& shape) : shape_(shape) {}
  /// @param apex how far from it [rad].
  Prolate next(double apex) {
    std::uniform_real_distribution<double> wall(shape_.lambda_inner + 0.03, shape_.lambda_outer - 0.03),
        along(apex, shape_.mu_base - 0.05), around(-std::numbers::pi, std::numbers::pi);
    return {wall(random_), along(random_), around(random_)};
  }

 private:
  const Ventricle& shape_;
  std::mt19937 random_{11};
};

/// Of the helix angle, in degrees.
struct HelixError {
  double worst = 0.0, mean = 0.0;  ///< root mean square
};

/// At random places of a shell of that resolution.
HelixError helix_error(const VentricleCells& cells, double apex = 0.35) {
  const Ventricle shape;
  const Heart heart = heart_of(ventricle_mesh(shape, cells));
  const SmoothNormals normals(heart.layer);
  const auto axis = long_axis(*heart.layer);
  EXPECT_TRUE(axis);
  RandomPlaces places(shape);
  CellHint hint;
  HelixError error;
  constexpr int kPlaces = 2000;
  for (int i = 0; i < kPlaces; ++i) {
    const Prolate at = places.next(apex);
    const Vec3 x = shape.position(at);
    const TensorSample sample = heart.fibres->sample(x, hint);
    TetPoint place;
    if (sample.status != SampleStatus::kOk ||
        !heart.layer->tet_mesh()->locate(heart.layer->frame().local_from_data(x),
                                         static_cast<CellIndex>(hint.cell), place)) {
      ADD_FAILURE() << "no fibre at " << x.x << ", " << x.y << ", " << x.z;
      continue;
    }
    const auto angle = wall_angle(
        WallAngle::kHelix, AngleConvention::kStreeter,
        {.axis = *axis, .transmural = normals.at(place), .fibre = symmetric_eigen(sample.value).vectors[0]});
    EXPECT_TRUE(angle);
    const double off = std::abs(*angle - shape.helix_angle(at.lambda)) / kDegree;
    error.worst = std::max(error.worst, off);
    error.mean += off * off / kPlaces;
  }
  error.mean = std::sqrt(error.mean);
  return error;
}

TEST(Heart, HelixAngleIsExactToHalfADegree) { EXPECT_LT(helix_error({}).worst, 0.5); }

TEST(Heart, HelixAngleConvergesAtSecondOrderAtLeast) {
  // Off the apex, where directions turn by any angle from cell to cell.
  const double coarse = helix_error({.wall = 4, .along = 24, .around = 48}, 0.9).mean;
  const double fine = helix_error({.wall = 8, .along = 48, .around = 96}, 0.9).mean;
  // Interpolated directions add a part that falls faster.
  EXPECT_GT(std::log2(coarse / fine), 1.9) << coarse << " -> " << fine;
}

TEST(Heart, RandomSignsChangeNoBit) {
  DataSet mesh = ventricle_mesh({}, {.wall = 2, .along = 8, .around = 16});
  const Heart before = heart_of(mesh);
  std::mt19937 random{3};
  DataArray& fibres = mesh.arrays.front();
  ASSERT_EQ(fibres.name, "fibre");
  std::vector<double> flipped;
  for (std::size_t p = 0; p < fibres.tuples; ++p) {
    const double sign = (random() & 1U) != 0 ? -1.0 : 1.0;
    for (int c = 0; c < 3; ++c) flipped.push_back(sign * fibres.at(p, c));
  }
  fibres = make_array("fibre", Association::kPoint, 3, std::span<const double>(flipped));
  const Heart after = heart_of(mesh);
  const auto a = std::get<std::span<const double>>(before.fibres->values());
  const auto b = std::get<std::span<const double>>(after.fibres->values());
  ASSERT_EQ(a.size(), b.size());
  EXPECT_EQ(std::memcmp(a.data(), b.data(), a.size_bytes()), 0);
  const SmoothNormals normals(before.layer);
  const Vec3 axis = *long_axis(*before.layer);
  const auto angles = [&](const Heart& heart) {
    return map_angle(heart, normals, axis, WallAngle::kHelix, AngleConvention::kBayer);
  };
  const std::vector<double> first = angles(before), second = angles(after);
  EXPECT_EQ(std::memcmp(first.data(), second.data(), first.size() * sizeof(double)), 0);
}

TEST(Heart, LongAxisPointsFromApexToBase) {
  const Heart heart = heart_of(ventricle_mesh({}, {.wall = 2, .along = 16, .around = 24}));
  const auto axis = long_axis(*heart.layer);
  ASSERT_TRUE(axis);
  EXPECT_NEAR(axis->x, 0.0, 1e-12);
  EXPECT_NEAR(axis->y, 0.0, 1e-12);
  EXPECT_NEAR(axis->z, 1.0, 1e-12);
}

TEST(Heart, LayersWithoutAnArrayComeFromLaplace) {
  DataSet mesh = ventricle_mesh({}, {.wall = 4, .along = 16, .around = 24});
  std::erase_if(mesh.arrays, [](const DataArray& array) { return array.name == "layer"; });
  const Heart heart = heart_of(mesh);
  EXPECT_EQ(heart.layer->lowest(), 0.0);
  EXPECT_EQ(heart.layer->highest(), 1.0);
}

TEST(Heart, FibresOfCellsAreBroughtToPointsWithoutTheirSigns) {
  // Two tetrahedra that share a face, fibres along x with opposite signs: a mean of vectors would be zero.
  DataSet mesh;
  UnstructuredTopology topology;
  const std::vector<double> x{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 1};
  topology.positions = make_array("x", Association::kPoint, 3, std::span<const double>(x));
  topology.types = {10, 10};
  topology.offsets = {0, 4, 8};
  topology.connectivity = {0, 1, 2, 3, 1, 2, 3, 4};
  mesh.topology = topology;
  const std::vector<double> fibres{1, 0, 0, -1, 0, 0}, layer{0, 0, 0, 1, 1};
  mesh.arrays = {make_array("fibres", Association::kCell, 3, std::span<const double>(fibres)),
                 make_array("layer", Association::kPoint, 1, std::span<const double>(layer))};
  const Heart heart = heart_of(mesh);
  for (const double gap : map_gap(heart)) EXPECT_NEAR(gap, 1.0, 1e-12);
}

TEST(Heart, WhatIsNoHeartIsNamed) {
  DataSet mesh = ventricle_mesh({}, {.wall = 1, .along = 4, .around = 8});
  const std::vector<ArrayInfo> arrays = arrays_of(mesh);
  EXPECT_THROW((void)choose_heart(arrays, "nonsense", "file"), Error);
  const std::vector<ArrayInfo> without(arrays.begin() + 1, arrays.end());  // sheet and normal are no fibres
  EXPECT_THROW((void)choose_heart(without, "", "file"), Error);
  const std::vector<double> flat(mesh.point_count(), 0.5);
  mesh.arrays[3] = make_array("layer", Association::kPoint, 1, std::span<const double>(flat));
  EXPECT_THROW((void)heart_of(mesh), Error);
}

TEST(FibreAngles, RotationsComeBackUnderEachConvention) {
  // A wall that leans: transmural and long axis are not at a right angle, so that the frames differ.
  const Vec3 axis{0.0, 0.0, 2.0}, transmural = Vec3{3.0, 0.0, -1.5};
  for (const AngleConvention convention :
       {AngleConvention::kBayer, AngleConvention::kPiersanti, AngleConvention::kDoste}) {
    const bool keeps_axis = convention != AngleConvention::kPiersanti;
    const Vec3 e_c{0.0, 1.0, 0.0};
    const Vec3 e_t = keeps_axis ? Vec3{1.0, 0.0, 0.0} : glm::normalize(transmural);
    const Vec3 e_l = glm::cross(e_t, e_c);
    for (const double alpha : {-70.0, -10.0, 35.0, 88.0}) {
      for (const double beta : {-60.0, 0.0, 25.0}) {
        const double ca = std::cos(alpha * kDegree), sa = std::sin(alpha * kDegree);
        const double cb = std::cos(beta * kDegree), sb = std::sin(beta * kDegree);
        const Vec3 f = ca * e_c + sa * e_l, across = -sa * e_c + ca * e_l;
        WallDirections at{.axis = axis, .transmural = transmural, .fibre = -f};
        WallAngle second = WallAngle::kSheet;
        if (convention == AngleConvention::kDoste) {
          at.fibre = -(cb * f - sb * e_t);
          second = WallAngle::kTransverse;
        } else {
          at.sheet = -(cb * e_t + sb * across);
        }
        const auto helix = wall_angle(WallAngle::kHelix, convention, at);
        const auto other = wall_angle(second, convention, at);
        ASSERT_TRUE(helix && other);
        EXPECT_NEAR(*helix / kDegree, alpha, 1e-9) << name_of(convention);
        EXPECT_NEAR(*other / kDegree, beta, 1e-9) << name_of(convention);
      }
    }
  }
}

TEST(FibreAngles, StreeterProjectsOnPlanes) {
  const WallDirections at{.axis = {0, 0, 1}, .transmural = {1, 0, 0}, .fibre = {-0.5, -1.0, -2.0}};
  EXPECT_NEAR(*wall_angle(WallAngle::kHelix, AngleConvention::kStreeter, at), std::atan(2.0), 1e-15);
  EXPECT_NEAR(*wall_angle(WallAngle::kTransverse, AngleConvention::kStreeter, at), std::atan(0.5), 1e-15);
}

TEST(FibreAngles, UndefinedOnesHaveNoValue) {
  using enum AngleConvention;
  const WallDirections apex{.axis = {0, 0, 1}, .transmural = {0, 0, -1}, .fibre = {1, 0, 0}};
  EXPECT_FALSE(wall_angle(WallAngle::kHelix, kStreeter, apex));
  const WallDirections through{.axis = {0, 0, 1}, .transmural = {1, 0, 0}, .fibre = {1, 0, 0}};
  EXPECT_FALSE(wall_angle(WallAngle::kHelix, kStreeter, through));
  EXPECT_FALSE(wall_angle(WallAngle::kSheet, kDoste, through));
  EXPECT_FALSE(defines(kBayer, WallAngle::kTransverse));
}

}  // namespace
}  // namespace palpate
