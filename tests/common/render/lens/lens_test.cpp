#include "common/render/lens/lens.h"

#include <array>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/half_space.h"

namespace palpate {
namespace {

struct NamedShape {
  std::string name;
  ConvexShape shape;
};

ConvexShape tetrahedron() {
  const std::array<ConvexShape::HalfSpace, 4> faces{
      {{{-2.0, 0.0, 0.0}, 0.4}, {{0.0, -1.0, 0.0}, 0.3}, {{0.0, 0.0, -3.0}, 0.9}, {{1.0, 1.0, 1.0}, 0.6}}};
  return make_polyhedron(faces);
}

std::vector<NamedShape> shapes() {
  const Mat3 turned(Vec3(0.32, 0.24, 0.0), Vec3(-0.3, 0.4, 0.0), Vec3(0.0, 0.0, 0.6));
  return {{"sphere", make_sphere({0.1, -0.2, 0.3}, 0.7)},
          {"box", make_box({0.2, 0.0, -0.1}, turned)},
          {"cylinder", make_cylinder({-0.5, 0.1, 0.0}, {0.4, 0.3, 0.6}, 0.3)},
          {"half-space", test::make_half_space({0.1, 0.0, 0.0}, {1.0, 2.0, -0.5})},
          {"polyhedron", tetrahedron()}};
}

// Membership by its definition decides where the line is inside.
TEST(ConvexShape, CutsLinesWhereTheyEnterAndLeave) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const auto point = [&] { return Vec3(unit(random), unit(random), unit(random)); };
  for (const auto& [name, shape] : shapes()) {
    int hits = 0;
    for (int i = 0; i < 500; ++i) {
      const Vec3 origin = point(), direction = point();
      const LineInterval inside = clip_line(shape, origin, direction);
      hits += inside.first < inside.last ? 1 : 0;
      for (double t = -5.0; t < 5.0; t += 0.037) {
        if (std::abs(t - inside.first) < 1e-9 || std::abs(t - inside.last) < 1e-9) continue;
        ASSERT_EQ(shape.contains(origin + t * direction), t > inside.first && t < inside.last)
            << name << " at " << t;
      }
    }
    EXPECT_GT(hits, 50) << name;
  }
}

TEST(ConvexShape, OfNoSizeHoldsNoLine) {
  const Vec3 direction(1.0, 0.0, 0.0);
  for (const ConvexShape& shape : {make_sphere(Vec3(0.0), 0.0), make_cylinder(Vec3(0.0), Vec3(1.0), 0.0)}) {
    const LineInterval inside = clip_line(shape, Vec3(-1.0, 0.0, 0.0), direction);
    EXPECT_GE(inside.first, inside.last);
  }
}

TEST(ConvexShape, HoldsAllOfALineAlongTheAxisOfAnEndlessCylinder) {
  ConvexShape endless = make_cylinder(Vec3(0.0), Vec3(0.0, 0.0, 1.0), 0.5);
  endless.half_spaces.clear();
  EXPECT_LT(clip_line(endless, Vec3(0.2, 0.0, 0.0), Vec3(0.0, 0.0, 1.0)).first, -1e300);
  const LineInterval beside = clip_line(endless, Vec3(0.6, 0.0, 0.0), Vec3(0.0, 0.0, 1.0));
  EXPECT_GE(beside.first, beside.last);
}

TEST(ConvexShape, OfSphereHasItsRadius) {
  const LineInterval inside = clip_line(make_sphere({1.0, 0.0, 0.0}, 0.5), Vec3(0.0), Vec3(1.0, 0.0, 0.0));
  EXPECT_DOUBLE_EQ(inside.first, 0.5);
  EXPECT_DOUBLE_EQ(inside.last, 1.5);
}

// The middle goes along when a shape is moved and scaled; that of a tetrahedron is the mean of its corners.
TEST(ConvexShape, KnowsTheMiddleOfPolyhedra) {
  const std::array<ConvexShape::HalfSpace, 4> faces{
      {{{-2.0, 0.0, 0.0}, 0.0}, {{0.0, -1.0, 0.0}, 0.0}, {{0.0, 0.0, -1.0}, 0.0}, {{1.0, 1.0, 1.0}, 4.0}}};
  const ConvexShape wedge = make_polyhedron(faces);
  EXPECT_LT(glm::distance(center_of(wedge, Vec3(9.0)), Vec3(1.0)), 1e-12);
  const ConvexShape other = scaled(moved(wedge, {1.0, 2.0, 3.0}), 3.0);
  EXPECT_LT(glm::distance(center_of(other, Vec3(9.0)), Vec3(2.0, 3.0, 4.0)), 1e-12);
}

TEST(Magnification, NeedsBoundsAndRoom) {
  const auto can = [](const ConvexShape& shape) {
    Lens lens{shape};
    lens.magnification = 2.0;
    return magnifies(lens);
  };
  EXPECT_TRUE(can(make_sphere({1.0, 2.0, 3.0}, 1e-6)));
  EXPECT_TRUE(can(make_box({1.0, 2.0, 3.0}, Mat3(0.5))));
  EXPECT_TRUE(can(make_cylinder(Vec3(1.0), Vec3(2.0), 0.1)));
  EXPECT_FALSE(can(test::make_half_space(Vec3(0.0), {0.0, 0.0, 1.0})));
  EXPECT_FALSE(can(make_sphere(Vec3(0.0), 0.0)));
  EXPECT_FALSE(can(make_box(Vec3(0.0), Mat3(0.0))));
  std::vector<ConvexShape::HalfSpace> corner{
      {{-1.0, 0.0, 0.0}, 0.0}, {{0.0, -1.0, 0.0}, 0.0}, {{0.0, 0.0, -1.0}, 0.0}};
  EXPECT_FALSE(can(make_polyhedron(corner)));  // goes on for ever
  corner.push_back({{1.0, 1.0, 1.0}, 1.0});
  EXPECT_TRUE(can(make_polyhedron(corner)));
  corner.back().offset = -1.0;  // and nothing is inside
  EXPECT_FALSE(can(make_polyhedron(corner)));
  ConvexShape tube = make_cylinder(Vec3(0.0), {0.0, 0.0, 1.0}, 0.1);
  tube.half_spaces.pop_back();
  EXPECT_FALSE(can(tube));
  Lens cut{make_sphere(Vec3(0.0), 1.0)};
  cut.magnification = 2.0;
  cut.cut = true;
  EXPECT_FALSE(magnifies(cut));
}

}  // namespace
}  // namespace palpate
