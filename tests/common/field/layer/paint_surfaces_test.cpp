// Surfaces that a user paints, and those that a file names by number: what is right is known from how they were made.
#include "common/field/layer/paint_surfaces.h"

#include <cmath>
#include <functional>
#include <numbers>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/field/analytic/ventricle.h"
#include "common/field/layer/wall_layer.h"
#include "tests/support/two_ventricles.h"

namespace palpate {
namespace {

double area_of(const WallSurfaces& surfaces, BorderRole role) {
  return surfaces.areas[static_cast<std::size_t>(role)];
}

/// The ventricle without anything that says what its surfaces are.
DataSet bare_ventricle() {
  DataSet mesh = ventricle_mesh({}, {.wall = 4, .along = 20, .around = 48});
  mesh.arrays.clear();
  return mesh;
}

TEST(SurfacePaint, IsWhatTheBorderInTheBallIsAndNotTheFarSideOfTheWall) {
  const Ventricle shape;
  const DataSet mesh = bare_ventricle();
  const auto grid = make_field_grid(std::span(&mesh, 1), "heart", 1);
  const WallSurfaces found = find_wall_surfaces(*grid, mesh, "heart");
  // On the epicardium, half way up; the ball reaches through the wall.
  const Vec3 at = shape.position({shape.lambda_outer, 1.2, 0.3});
  const double thickness = glm::distance(at, shape.position({shape.lambda_inner, 1.2, 0.3})),
               radius = 1.5 * thickness;
  const std::vector<SurfacePaint> paint{{BorderRole::kBase, at, radius}};
  const WallSurfaces painted = find_painted_surfaces(*grid, mesh, "heart", paint);
  const double disc = std::numbers::pi * radius * radius;
  EXPECT_NEAR(area_of(painted, BorderRole::kBase) - area_of(found, BorderRole::kBase), disc, 0.15 * disc);
  EXPECT_NEAR(area_of(found, BorderRole::kOuter) - area_of(painted, BorderRole::kOuter), disc, 0.15 * disc);
  EXPECT_EQ(area_of(found, BorderRole::kInner), area_of(painted, BorderRole::kInner));
  EXPECT_NE(painted.note.find("painted at 1 place"), std::string::npos) << painted.note;
  // No depth is given there any more, so that it is less than 1.
  const WallLayer layer = make_wall_layer(*grid, mesh, "heart", 1, paint);
  double least = 1.0;
  for (std::size_t p = 0; p < grid->tets->points().size(); ++p)
    if (glm::distance(grid->frame.data_from_local(grid->tets->points()[p]), at) < 0.2 * radius)
      least = std::min(least, layer.array.at(p));
  EXPECT_LT(least, 0.95);
  // Painted back by a second ball: the last one counts.
  const std::vector<SurfacePaint> back{{BorderRole::kBase, at, radius}, {BorderRole::kOuter, at, radius}};
  EXPECT_NEAR(area_of(find_painted_surfaces(*grid, mesh, "heart", back), BorderRole::kOuter),
              area_of(found, BorderRole::kOuter), 1e-9);
}

// A slab has no inner side by its shape: paint alone says which is which.
TEST(SurfacePaint, TellsSurfacesWhereNoneAreFound) {
  std::vector<double> x;
  for (int i = 0; i < 8; ++i) x.insert(x.end(), {4.0 * (i & 1), 4.0 * ((i >> 1) & 1), 1.0 * (i >> 2)});
  UnstructuredTopology topology;
  topology.positions = make_array("points", Association::kPoint, 3, std::span<const double>(x));
  topology.connectivity = {0, 1, 3, 2, 4, 5, 7, 6};
  topology.offsets = {0, 8};
  topology.types = {12};
  DataSet mesh;
  mesh.topology = std::move(topology);
  const auto grid = make_field_grid(std::span(&mesh, 1), "slab", 1);
  EXPECT_THROW((void)find_wall_surfaces(*grid, mesh, "slab"), Error);
  const WallLayer layer =
      make_wall_layer(*grid, mesh, "slab", 1, parse_paint({"inner:2,2,0,4", "outer:2,2,1,4"}));
  for (std::size_t p = 0; p < 8; ++p) EXPECT_NEAR(layer.array.at(p), p < 4 ? 0.0 : 1.0, 1e-9) << p;
  EXPECT_THROW((void)find_painted_surfaces(*grid, mesh, "slab", parse_paint({"inner:2,2,0,4"})), Error);
}

TEST(SurfacePaint, IsReadAsItIsWritten) {
  const std::vector<SurfacePaint> paint = parse_paint({"inner:1,2,3,4", "septum:0.1,-2e-3,5,0.25"});
  ASSERT_EQ(paint.size(), 2U);
  EXPECT_EQ(paint[0], (SurfacePaint{BorderRole::kInner, {1.0, 2.0, 3.0}, 4.0}));
  EXPECT_EQ(parse_paint({paint_text(paint[1])}).front(), paint[1]);
  for (const char* wrong :
       {"", "inner", "inner:1,2,3", "inside:1,2,3,4", "inner:1,2,3,0", "inner:1,2,3,-1", "inner:a,b,c,d"})
    EXPECT_THROW((void)parse_paint({wrong}), Error) << wrong;
}

// What 'info --surfaces' writes into a mesh is read back: of two ventricles, too.
/// A mesh with the array that names what was found. @param number of a role.
DataSet tagged_mesh(const DataSet& mesh, const FieldGrid& grid, const WallSurfaces& found,
                    const std::function<int(BorderRole)>& number) {
  std::vector<double> tags(grid.tets->points().size(), 0.0);
  for (const BorderRole role :
       {BorderRole::kBase, BorderRole::kOuter, BorderRole::kSeptum, BorderRole::kRight, BorderRole::kInner})
    give_on(found, role, number(role), tags);
  DataSet tagged = mesh;
  std::vector<double> of_input;
  for (std::size_t p = 0; p < tagged.point_count(); ++p)
    of_input.push_back(tags[grid.point_of_input.empty() ? p : grid.point_of_input[p]]);
  tagged.arrays.push_back(
      make_array(kSurfaceArray, Association::kPoint, 1, std::span<const double>(of_input)));
  return tagged;
}

TEST(TaggedSurfaces, NumbersOfPointsAreTheSurfacesThatWereFound) {
  const test::TwoVentricles heart(130.0 * std::numbers::pi / 180.0);
  const auto grid = make_field_grid(std::span(&heart.mesh, 1), "heart", 1);
  const WallSurfaces found = find_wall_surfaces(*grid, heart.mesh, "heart");
  const DataSet tagged = tagged_mesh(heart.mesh, *grid, found, tag_of);
  const WallSurfaces read = find_wall_surfaces(*grid, tagged, "heart");
  double wrong = 0.0, all = 0.0;
  for (std::size_t t = 0; t < read.roles.size(); ++t) {
    const auto [a, b, c] = read.triangles[t];
    const auto points = grid->tets->points();
    const double area = glm::length(glm::cross(points[b] - points[a], points[c] - points[a]));
    all += area;
    if (read.roles[t] != found.roles[t]) wrong += area;
  }
  EXPECT_LT(wrong, 0.03 * all) << "rims alone, whose points belong to two";
  for (const BorderRole role : {BorderRole::kRight, BorderRole::kSeptum})
    EXPECT_NEAR(area_of(read, role), area_of(found, role), 0.1 * area_of(found, role)) << name_of(role);
  const WallLayer by_tags = make_wall_layer(tagged, "heart"), by_shape = make_wall_layer(heart.mesh, "heart");
  for (std::size_t p = 0; p < by_tags.array.tuples; ++p)
    ASSERT_EQ(by_tags.array.at(p), by_shape.array.at(p)) << p << ": to the last bit";
}

// Programs name a right endocardium as one surface, both its sides: the septum's counts as outer all the same.
TEST(TaggedSurfaces, TheSeptumOfARightEndocardiumIsFound) {
  for (const double degrees : {70.0, 110.0, 150.0}) {
    const test::TwoVentricles heart(degrees * std::numbers::pi / 180.0);
    const auto grid = make_field_grid(std::span(&heart.mesh, 1), "heart", 1);
    const WallSurfaces found = find_wall_surfaces(*grid, heart.mesh, "heart");
    const DataSet tagged = tagged_mesh(heart.mesh, *grid, found, [](BorderRole role) {
      return tag_of(role == BorderRole::kSeptum ? BorderRole::kRight : role);
    });
    const WallSurfaces read = find_wall_surfaces(*grid, tagged, "heart");
    EXPECT_NE(read.note.find("names no septum"), std::string::npos) << read.note;
    const double exact = area_of(found, BorderRole::kSeptum);
    EXPECT_NEAR(area_of(read, BorderRole::kSeptum), exact, 0.1 * exact) << degrees;
    EXPECT_TRUE(read.doubts.empty()) << read.doubts.front();
    std::size_t other = 0;
    for (std::size_t p = 0; p < read.of_point.size(); ++p)
      other += read.of_point[p] == found.of_point[p] ? 0 : 1;
    EXPECT_LE(other, read.of_point.size() / 100) << degrees << ": points at rims alone";
  }
}

TEST(TaggedSurfaces, WhatIsNamedTheOtherWayRoundOrInPartIsDoubted) {
  const test::TwoVentricles heart(130.0 * std::numbers::pi / 180.0);
  const auto grid = make_field_grid(std::span(&heart.mesh, 1), "heart", 1);
  const WallSurfaces found = find_wall_surfaces(*grid, heart.mesh, "heart");
  const auto doubts = [&](const std::function<int(BorderRole)>& number) {
    const WallSurfaces read =
        find_wall_surfaces(*grid, tagged_mesh(heart.mesh, *grid, found, number), "heart");
    return read.doubts.empty() ? std::string() : read.doubts.front();
  };
  EXPECT_EQ(doubts(tag_of), "");
  const std::string turned = doubts([](BorderRole role) {
    return tag_of(role == BorderRole::kOuter   ? BorderRole::kInner
                  : role == BorderRole::kInner ? BorderRole::kOuter
                                               : BorderRole::kLeft);
  });
  EXPECT_NE(turned.find("other way round"), std::string::npos) << turned;
  const std::string part = doubts([](BorderRole role) {
    return role == BorderRole::kRight || role == BorderRole::kSeptum ? 0 : tag_of(role);
  });
  EXPECT_NE(part.find("leaves out"), std::string::npos) << part;
}

}  // namespace
}  // namespace palpate
