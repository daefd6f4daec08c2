// Fibres, layers and angles of a heart, against the ventricle whose formulas are known.
#include "common/field/heart/heart.h"

#include <algorithm>
#include <array>
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
#include "tests/support/zone_mesh.h"

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

TEST(Heart, HelixAngleIsExactToHalfADegree) {
  const double worst = helix_error({}).worst;
  RecordProperty("worst_degrees", std::to_string(worst));
  EXPECT_LT(worst, 0.5);
}

TEST(Heart, HelixAngleConvergesAtSecondOrderAtLeast) {
  // Off the apex, where directions turn by any angle from cell to cell.
  const double coarse = helix_error({.wall = 4, .along = 24, .around = 48}, 0.9).mean;
  const double fine = helix_error({.wall = 8, .along = 48, .around = 96}, 0.9).mean;
  // Interpolated directions add a part that falls faster.
  EXPECT_GT(std::log2(coarse / fine), 1.9) << coarse << " -> " << fine;
}

// Of fibres in their layer, alpha from e_c: those that keep t measure alpha itself; those that keep the long axis see
// its part along that, a . e_l = cosh(lambda) sin(mu) / sqrt(sinh^2 lambda + sin^2 mu).
TEST(Heart, HelixMapsAreTheClosedFormsOfFourConventions) {
  const Ventricle shape;
  const Heart heart = heart_of(ventricle_mesh(shape, {}));
  const SmoothNormals normals(heart.layer);
  const auto axis = long_axis(*heart.layer);
  ASSERT_TRUE(axis);
  const auto points = heart.layer->tet_mesh()->points();
  for (int c = 0; c < kAngleConventionCount; ++c) {
    const auto convention = static_cast<AngleConvention>(c);
    const bool leans = convention == AngleConvention::kBayer || convention == AngleConvention::kDoste;
    const std::vector<double> map = map_angle(heart, normals, *axis, WallAngle::kHelix, convention);
    ASSERT_EQ(map.size(), points.size());
    double worst = 0.0;
    std::size_t compared = 0;
    for (std::size_t p = 0; p < map.size(); ++p) {
      const Prolate at = shape.coordinates(heart.layer->frame().data_from_local(points[p]));
      constexpr double kApex = 0.35;  // where directions turn by any angle from cell to cell
      if (at.mu < kApex) continue;
      const double alpha = shape.helix_angle(at.lambda);
      const double part =
          std::cosh(at.lambda) * std::sin(at.mu) / std::hypot(std::sinh(at.lambda), std::sin(at.mu));
      worst = std::max(worst, std::abs(map[p] - std::atan(std::tan(alpha) * (leans ? part : 1.0)) / kDegree));
      ++compared;
    }
    RecordProperty("worst_degrees_" + std::string(name_of(convention)), std::to_string(worst));
    EXPECT_LT(worst, 0.5) << name_of(convention);
    EXPECT_GT(compared, points.size() / 2);
  }
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

/// The tetrahedra of a slab 0 <= x, y <= 3, 0 <= z <= 1 whose depth is z, with fibres along x.
struct Slab {
  std::vector<double> x, fibres, depth;
  std::vector<std::int64_t> corners;

  Slab() {
    constexpr int kSide = 4, kHigh = 3;
    for (int k = 0; k < kHigh; ++k)
      for (int j = 0; j < kSide; ++j)
        for (int i = 0; i < kSide; ++i) {
          x.insert(x.end(), {1.0 * i, 1.0 * j, 0.5 * k});
          fibres.insert(fibres.end(), {1.0, 0.0, 0.0});
          depth.push_back(0.5 * k);
        }
    const auto at = [](int i, int j, int k) { return std::int64_t{i + kSide * (j + kSide * k)}; };
    constexpr std::array<std::array<int, 3>, 7> kRound{
        {{1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 1, 1}, {0, 0, 1}, {1, 0, 1}, {1, 0, 0}}};
    for (int k = 0; k + 1 < kHigh; ++k)
      for (int j = 0; j + 1 < kSide; ++j)
        for (int i = 0; i + 1 < kSide; ++i)
          for (std::size_t n = 0; n < 6; ++n) {
            const auto& a = kRound[n];
            const auto& b = kRound[n + 1];
            corners.insert(corners.end(), {at(i, j, k), at(i + a[0], j + a[1], k + a[2]),
                                           at(i + b[0], j + b[1], k + b[2]), at(i + 1, j + 1, k + 1)});
          }
  }
  [[nodiscard]] DataSet mesh() const {
    DataSet data;
    UnstructuredTopology cells;
    cells.positions = make_array("x", Association::kPoint, 3, std::span<const double>(x));
    cells.types.assign(corners.size() / 4, 10);
    for (std::size_t c = 0; c <= cells.types.size(); ++c)
      cells.offsets.push_back(static_cast<std::int64_t>(4 * c));
    cells.connectivity = corners;
    data.topology = std::move(cells);
    data.arrays = {make_array("fibre", Association::kPoint, 3, std::span<const double>(fibres)),
                   make_array("layer", Association::kPoint, 1, std::span<const double>(depth))};
    return data;
  }
};

/// Whether depth and fibres are those of the slab all over it.
void expect_slab(const Heart& heart) {
  std::mt19937 random{5};
  std::uniform_real_distribution<double> part(0.001, 0.999);
  CellHint hint;
  for (int i = 0; i < 500; ++i) {
    const Vec3 x{3.0 * part(random), 3.0 * part(random), part(random)};
    const ScalarSample depth = heart.layer->sample(x, hint);
    const TensorSample fibre = heart.fibres->sample(x, hint);
    ASSERT_EQ(depth.status, SampleStatus::kOk) << x.x << ", " << x.y << ", " << x.z;
    ASSERT_NEAR(depth.value, x.z, 1e-12);
    ASSERT_EQ(fibre.status, SampleStatus::kOk);
    ASSERT_NEAR(std::abs(symmetric_eigen(fibre.value).vectors[0].x), 1.0, 1e-12);
  }
  // Every normal of the layers is known.
  const SmoothNormals normals(heart.layer);
  for (std::size_t p = 0; p < heart.layer->tet_mesh()->points().size(); ++p)
    ASSERT_NEAR(normals.at_point(p).z, 1.0F, 1e-5F);
}

TEST(DegenerateHeart, InvertedAndFlatTetrahedraChangeNothing) {
  Slab slab;
  for (std::size_t c = 0; c < slab.corners.size(); c += 28) std::swap(slab.corners[c], slab.corners[c + 1]);
  slab.corners.insert(slab.corners.end(), {0, 1, 2, 3, 0, 1, 5, 4, 7, 7, 7, 7, 2, 3, 2, 7});  // line, plane
  const Heart heart = heart_of(slab.mesh());
  EXPECT_GT(heart.layer->tet_mesh()->zero_volume_count(), 0U);
  expect_slab(heart);
}

bool says(const Heart& heart, const char* words) {
  return std::ranges::any_of(
      heart.notes, [words](const std::string& note) { return note.find(words) != std::string::npos; });
}

// The tetrahedron behind a face is put before it, where another one is.
TEST(DegenerateHeart, TetrahedraThatOverlapAreSaid) {
  Slab slab;
  slab.corners = {0, 1, 4, 16, 1, 4, 16, 21};
  EXPECT_FALSE(says(heart_of(slab.mesh()), "1 face with both tetrahedra on one side"));
  slab.x[3 * 21] = slab.x[3 * 21 + 1] = 0.1;
  slab.x[3 * 21 + 2] = 0.2;
  EXPECT_TRUE(says(heart_of(slab.mesh()), "1 face with both tetrahedra on one side"));
}

TEST(DegenerateHeart, OneWithoutAnyVolumeIsRefused) {
  Slab slab;
  slab.corners = {0, 1, 2, 3, 0, 1, 5, 4};
  try {
    (void)heart_of(slab.mesh());
    ADD_FAILURE() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::kBadInput);
    EXPECT_NE(std::string(error.what()).find("volume"), std::string::npos) << error.what();
  }
}

// Every other tetrahedron names points of its own: without joining, the wall is a heap of pieces.
TEST(DegenerateHeart, PointsAtOnePlaceAreJoined) {
  Slab slab;
  const auto points = static_cast<std::int64_t>(slab.depth.size());
  const auto twice = [](std::vector<double>& v) {
    const std::vector<double> once = v;
    v.insert(v.end(), once.begin(), once.end());
  };
  twice(slab.x);
  twice(slab.fibres);
  twice(slab.depth);
  for (std::size_t c = 0; c < slab.corners.size(); ++c)
    if (c / 4 % 2 == 1) slab.corners[c] += points;
  const Heart heart = heart_of(slab.mesh());
  expect_slab(heart);
  EXPECT_EQ(heart.layer->tet_mesh()->points().size(), static_cast<std::size_t>(points));
  std::size_t border = 0;
  for (const auto& cell : heart.layer->tet_mesh()->neighbors())
    border += static_cast<std::size_t>(std::count(cell.begin(), cell.end(), kNoCell));
  EXPECT_EQ(border, 2U * (9 + 9 + 6 + 6 + 6 + 6));
}

// A point without a direction among such as have one takes theirs; where there are none around there is none.
TEST(DegenerateHeart, MissingFibresAreTheMeanOfThoseAround) {
  Slab slab;
  for (const std::size_t p : {0U, 7U, 21U})
    for (std::size_t c = 0; c < 3; ++c) slab.fibres[3 * p + c] = p == 7 ? 0.0 : std::nan("");
  const Heart heart = heart_of(slab.mesh());
  EXPECT_EQ(heart.fibres->notes().bad_values, 0U);
  for (const double gap : map_gap(heart)) EXPECT_NEAR(gap, 1.0, 1e-12);
  bool said = false;
  for (const std::string& note : heart.notes)
    said = said || note == "3 points without a direction have the mean of the points around";
  EXPECT_TRUE(said);
  CellHint hint;
  EXPECT_EQ(heart.fibres->sample({0.1, 0.1, 0.1}, hint).status, SampleStatus::kOk);

  Slab bare;
  for (std::size_t c = 0; c < bare.fibres.size(); ++c)
    if (c >= 3) bare.fibres[c] = 0.0;
  const Heart without = heart_of(bare.mesh());
  EXPECT_EQ(without.fibres->notes().bad_values, bare.fibres.size() / 3 - 1) << "one direction is no mean";
  EXPECT_EQ(without.layer->sample({0.1, 0.1, 0.1}, hint).status, SampleStatus::kOk)
      << "layers are known all the same";
}

// What stands for no direction: placeholders a million times shorter than the others count as zeros do.
TEST(DegenerateHeart, DirectionsThatAreNextToNothingAreNone) {
  const DataSet whole = ventricle_mesh({}, {.wall = 2, .along = 8, .around = 16});
  const auto with = [&](double tiny) {
    DataSet mesh = whole;
    std::vector<double> values;
    for (std::size_t p = 0; p < mesh.arrays.front().tuples; ++p)
      for (int c = 0; c < 3; ++c) values.push_back(p % 3 == 0 ? tiny : 7.0 * mesh.arrays.front().at(p, c));
    mesh.arrays.front() = make_array("fibre", Association::kPoint, 3, std::span<const double>(values));
    return heart_of(mesh);
  };
  const Heart zero = with(0.0), tiny = with(1e-9);
  const auto a = std::get<std::span<const double>>(zero.fibres->values());
  const auto b = std::get<std::span<const double>>(tiny.fibres->values());
  ASSERT_EQ(a.size(), b.size());
  EXPECT_EQ(std::memcmp(a.data(), b.data(), a.size_bytes()), 0);
  EXPECT_TRUE(says(tiny, "a million times shorter"));
  EXPECT_FALSE(says(zero, "a million times shorter"));
}

TEST(DegenerateHeart, SheetsThatAreSkewToFibresAreSaid) {
  for (const bool skew : {false, true}) {
    DataSet mesh = ventricle_mesh({}, {.wall = 2, .along = 8, .around = 16});
    std::vector<double> values;
    const DataArray &fibre = *mesh.find("fibre", Association::kPoint),
                    &sheet = *mesh.find("sheet", Association::kPoint);
    for (std::size_t p = 0; p < sheet.tuples; ++p)
      for (int c = 0; c < 3; ++c)
        values.push_back(sheet.at(p, c) + (skew && p == 100 ? fibre.at(p, c) : 0.0));
    const auto at = std::ranges::find(mesh.arrays, "sheet", &DataArray::name);
    *at = make_array("sheet", Association::kPoint, 3, std::span<const double>(values));
    EXPECT_EQ(says(heart_of(mesh), "1 sheet of 'sheet' up to 45 degrees off"), skew);
  }
}

TEST(DegenerateHeart, OneTetrahedronIsOne) {
  Slab slab;
  slab.corners = {0, 1, 4, 16};
  const Heart heart = heart_of(slab.mesh());
  CellHint hint;
  EXPECT_NEAR(heart.layer->sample({0.2, 0.2, 0.1}, hint).value, 0.1, 1e-12);
  slab.depth.assign(slab.depth.size(), 0.0);
  EXPECT_THROW((void)heart_of(slab.mesh()), Error);
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
