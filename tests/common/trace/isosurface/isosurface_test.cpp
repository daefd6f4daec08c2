#include "common/trace/isosurface/isosurface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "common/field/analytic/volume_examples.h"
#include "common/field/grid/box_grid.h"
#include "tests/common/trace/sampled_scalars.h"
#include "tests/support/samples.h"
#include "tests/support/torus_scalar.h"

namespace palpate {
namespace {

using test::on_lattice;
using test::on_rectilinear;
using test::on_tets;
using test::on_uniform;

double unit(std::mt19937_64& random) { return static_cast<double>(random() >> 11U) * 0x1p-53; }
Vec3 random_in(const Box& box, std::mt19937_64& random) {
  const double x = unit(random), y = unit(random), z = unit(random);
  return box.lower + box.size() * Vec3{x, y, z};
}
Vec3 direction(std::mt19937_64& random) {
  for (;;) {
    const Vec3 v = random_in({Vec3{-1.0}, Vec3{1.0}}, random);
    const double length = glm::length(v);
    if (length > 0.1 && length <= 1.0) return v / length;
  }
}

Box local_bounds(const ScalarField& field) {
  return {field.frame().local_from_data(field.bounds().lower),
          field.frame().local_from_data(field.bounds().upper)};
}

/// In frame L, within the grid, whose axes may be at no right angles.
Vec3 random_in(const ScalarField& field, std::mt19937_64& random) {
  if (const BoxGrid* const grid = field.box_grid()) return grid->in_frame(random_in(grid->bounds(), random));
  return random_in(local_bounds(field), random);
}

constexpr int kPlenty = 100'000;

/// A point of the surface of `level` (data values), reached along random paths.
SurfacePoint point_on(const IsosurfaceSearch& search, const ScalarField& field, double level,
                      std::mt19937_64& random) {
  const SurfaceLevels levels{{level * field.value_scale()}, 1};
  for (;;) {
    SurfacePath path{.at = random_in(field, random)};
    SearchWork work{kPlenty};
    if (search.advance(path, random_in(field, random), levels, work) < 0) continue;
    return {path.at, levels.value[0], path.cell};
  }
}

double value_at(const ScalarField& field, const Vec3& x) {
  CellHint hint;
  Jet3 jet;
  EXPECT_EQ(field.jet(x, hint, jet), SampleStatus::kOk);
  return jet.value;
}

/// Whether the surface near `p` holds a point that is nearer to `x` by more than a part of the distance.
/// Points beside p are brought to the surface along random directions by halving: no cell, no gradient in it.
bool has_nearer_point(const ScalarField& field, const SurfacePoint& p, const Vec3& x, double radius,
                      std::mt19937_64& random) {
  CellHint hint;
  const auto value = [&](const Vec3& at) {
    Jet3 jet;
    return field.jet(at, hint, jet) == SampleStatus::kOk ? jet.value - p.level : NAN;
  };
  const double distance = glm::distance(x, p.position);
  for (int i = 0; i < test::samples_of(200); ++i) {
    const Vec3 middle = p.position + radius * unit(random) * direction(random);
    const Vec3 along = direction(random) * (2.0 * radius);
    Vec3 low = middle - along, high = middle + along;
    const double f_low = value(low), f_high = value(high);
    if (!(f_low * f_high < 0.0)) continue;
    for (int n = 0; n < 60; ++n) {
      const Vec3 half = 0.5 * (low + high);
      const double f = value(half);
      if (!std::isfinite(f)) break;
      (f * f_low > 0.0 ? low : high) = half;
    }
    if (glm::distance(low, p.position) > radius) continue;
    if (glm::distance(low, x) < distance * (1.0 - 1e-9) - 1e-12) return true;
  }
  return false;
}

TEST(Isosurface, ClosestPointsOfASphereAndATorusAreTheFormulas) {
  std::mt19937_64 random(1);
  const auto sphere = make_scalar_field(sphere_scalar());
  const auto torus = make_scalar_field(test::torus_scalar());
  const auto on_sphere = make_isosurface_search(sphere), on_torus = make_isosurface_search(torus);
  for (int i = 0; i < test::samples_of(300); ++i) {
    const Vec3 x = random_in({Vec3{-1.2}, Vec3{1.2}}, random);
    const double r = glm::length(x);
    if (r < 0.2) continue;
    SurfacePoint point = point_on(*on_sphere, *sphere, 1.0, random);
    SearchWork work{kPlenty};
    const SurfaceFit fit = on_sphere->settle(x, point, work);
    EXPECT_EQ(fit.end, SurfaceEnd::kClosest);
    EXPECT_LT(glm::distance(point.position, x / r), 1e-10) << r;
    EXPECT_EQ(fit.toward > 0.0, r > 1.0);
    // dp/dx = (1 - n n^T) / r on the unit sphere.
    const Vec3 n = x / r;
    const Mat3 expected = (Mat3{1.0} - glm::outerProduct(n, n)) * (1.0 / r);
    for (int axis = 0; axis < 3; ++axis) EXPECT_LT(glm::distance(fit.jacobian[axis], expected[axis]), 1e-8);

    // The torus of radii 1 and 0.4: from beyond its core circle x, seen from where the descent begins.
    const Vec3 far = random_in({Vec3{-1.4, -1.4, -0.7}, Vec3{1.4, 1.4, 0.7}}, random);
    const double axis_distance = std::hypot(far.x, far.y);
    if (axis_distance < 0.3) continue;
    const Vec3 core{far.x / axis_distance, far.y / axis_distance, 0.0};
    if (glm::distance(far, core) < 0.05) continue;
    point = point_on(*on_torus, *torus, 0.16, random);
    work = {kPlenty};
    EXPECT_EQ(on_torus->settle(far, point, work).end, SurfaceEnd::kClosest);
    EXPECT_NEAR(glm::distance(far, point.position), std::abs(glm::distance(far, core) - 0.4), 1e-10);
  }
}

class OnGrids : public testing::TestWithParam<int> {
 protected:
  [[nodiscard]] static std::shared_ptr<const ScalarField> field() {
    switch (GetParam()) {
      case 0:
        return on_uniform(marschner_lobb_scalar(), Index3{25});
      case 1:
        return on_rectilinear(marschner_lobb_scalar(), {20, 24, 28});
      case 2:
        return on_tets(marschner_lobb_scalar(), Index3{14});
      case 3:
        return on_tets(test::torus_scalar(), {19, 19, 11}, 0.2);
      case 5:
        return on_lattice(marschner_lobb_scalar(), Index3{25}, test::sheared_steps(1.0 / 12.0));
      default:
        return make_scalar_field(marschner_lobb_scalar());
    }
  }
  [[nodiscard]] static double level() { return GetParam() == 3 ? 0.1 : 0.5; }
};

// From anywhere to anywhere: on the surface, at a local minimum, and there to stay.
TEST_P(OnGrids, SettlesAtLocalMinimaOfTheDistance) {
  const auto scalar = field();
  const auto search = make_isosurface_search(scalar);

  std::mt19937_64 random(7);
  const double diagonal = scalar->diagonal() / scalar->frame().length_scale();
  int closest = 0;
  constexpr int kTimes = test::samples_of(400);
  for (int i = 0; i < kTimes; ++i) {
    SurfacePoint point = point_on(*search, *scalar, level(), random);
    const Vec3 start = point.position;
    // Near and far.
    const Vec3 x = point.position + direction(random) * (diagonal * std::pow(2.0, -8.0 * unit(random)));
    SearchWork work{kPlenty};
    const SurfaceFit fit = search->settle(x, point, work);
    EXPECT_LE(std::abs(value_at(*scalar, point.position) - point.level), 1e-11) << i;
    EXPECT_LE(std::abs(fit.error), 1e-11);
    EXPECT_LE(glm::distance(x, point.position), glm::distance(x, start) * (1.0 + 1e-12));
    if (fit.end != SurfaceEnd::kClosest) continue;
    ++closest;
    EXPECT_FALSE(has_nearer_point(*scalar, point, x, 1e-6 * diagonal, random)) << i;
    const SurfacePoint before = point;
    work = {kPlenty};
    const SurfaceFit again = search->settle(x, point, work);
    EXPECT_EQ(again.end, SurfaceEnd::kClosest) << i;
    EXPECT_GT(glm::length(again.gradient), 0.0) << i;
    // On sheared axes places are turned to and fro.
    EXPECT_LE(glm::distance(point.position, before.position), GetParam() == 5 ? 1e-12 * diagonal : 0.0) << i;
    EXPECT_EQ(point.cell, before.cell);
  }
  EXPECT_GE(closest, kTimes * 99 / 100);
}

// Every change of sides that dense samples of a straight path see is found, in its order.
TEST_P(OnGrids, PathsMissNoCrossing) {
  const auto scalar = field();
  const auto search = make_isosurface_search(scalar);
  std::mt19937_64 random(3);
  SurfaceLevels levels{{0.3, 0.5, 0.62}, 3};
  if (GetParam() == 3) levels.value = {0.05, 0.1, 0.4};
  for (int l = 0; l < 3; ++l) levels.value[static_cast<std::size_t>(l)] *= scalar->value_scale();
  int found = 0;
  for (int i = 0; i < test::samples_of(200); ++i) {
    const Vec3 from = random_in(*scalar, random), to = random_in(*scalar, random);
    constexpr int kSamples = 4000;
    std::array<int, 3> changes{};
    std::array<bool, 3> above{};
    for (int n = 0; n <= kSamples; ++n) {
      const double s = value_at(*scalar, from + (static_cast<double>(n) / kSamples) * (to - from));
      for (std::size_t l = 0; l < 3; ++l) {
        if (n > 0 && above[l] != (s >= levels.value[l])) ++changes[l];
        above[l] = s >= levels.value[l];
      }
    }
    SurfacePath path{.at = from};
    SearchWork work{kPlenty};
    std::array<int, 3> crossings{};
    double last = 0.0;
    for (;;) {
      const int level = search->advance(path, to, levels, work);
      if (level < 0) break;
      ++crossings[static_cast<std::size_t>(level)];
      EXPECT_NEAR(value_at(*scalar, path.at), levels.value[static_cast<std::size_t>(level)], 1e-10);
      EXPECT_GE(glm::distance(path.at, from), last - 1e-12);
      last = glm::distance(path.at, from);
      ++found;
    }
    EXPECT_EQ(path.at, to);
    for (std::size_t l = 0; l < 3; ++l) {
      EXPECT_GE(crossings[l], GetParam() == 4 ? 0 : changes[l]) << i;  // a formula is sampled
      EXPECT_EQ((crossings[l] - changes[l]) % 2, 0);
      EXPECT_EQ(path.side[l], above[l] ? 1 : -1);
    }
  }
  EXPECT_GT(found, test::samples_of(300));
}

// A plane on any lattice: its closest point is the foot of the perpendicular, in the world.
TEST(Isosurface, ClosestPointsOfAPlaneAreTheFeetOfPerpendicularsOnShearedAxes) {
  struct Plane final : AnalyticScalar {
    [[nodiscard]] double value(const Vec3& x) const noexcept override { return glm::dot(normal, x); }
    [[nodiscard]] Jet3 jet(const Vec3& x) const noexcept override {
      Jet3 out(value(x), normal);
      return out;
    }
    [[nodiscard]] Box bounds() const noexcept override { return {Vec3{-1.0}, Vec3{1.0}}; }
    [[nodiscard]] std::string name() const override { return "plane"; }
    [[nodiscard]] std::string description() const override { return "a plane"; }
    Vec3 normal{0.0};
  };
  std::mt19937_64 random(11);
  for (int lattice = 0; lattice < 20; ++lattice) {
    const auto plane = std::make_shared<Plane>();
    plane->normal = direction(random);
    Mat3 axes{direction(random), direction(random), direction(random)};
    if (std::abs(glm::determinant(axes)) < 0.2) continue;
    const auto field = on_lattice(plane, Index3{9}, 0.25 * axes);
    ASSERT_TRUE(field->box_grid() != nullptr && field->box_grid()->sheared());
    const auto search = make_isosurface_search(field);
    const LocalFrame& frame = field->frame();
    int inside = 0;
    for (int i = 0; i < 40; ++i) {
      const Vec3 x = frame.data_from_local(random_in(*field, random));
      const Vec3 foot = x - plane->normal * (plane->value(x) - 0.1);
      CellHint hint;
      if (field->sample(foot, hint).status != SampleStatus::kOk) continue;
      ++inside;
      SurfacePoint point = point_on(*search, *field, 0.1, random);
      SearchWork work{kPlenty};
      const SurfaceFit fit = search->settle(frame.local_from_data(x), point, work);
      EXPECT_EQ(fit.end, SurfaceEnd::kClosest);
      EXPECT_LT(glm::distance(frame.data_from_local(point.position), foot), 1e-9) << lattice;
      const Vec3 n = plane->normal * frame.rotation;
      EXPECT_LT(glm::distance(glm::normalize(fit.gradient), n), 1e-9);
      const Mat3 expected = Mat3{1.0} - glm::outerProduct(n, n);
      for (int axis = 0; axis < 3; ++axis) EXPECT_LT(glm::distance(fit.jacobian[axis], expected[axis]), 1e-8);
      EXPECT_EQ(fit.toward > 0.0, plane->value(x) > 0.1);
    }
    EXPECT_GT(inside, 5);
  }
}

INSTANTIATE_TEST_SUITE_P(Isosurface, OnGrids, testing::Range(0, 6));

}  // namespace
}  // namespace palpate
