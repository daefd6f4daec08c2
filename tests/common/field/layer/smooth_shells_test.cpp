// Walls carved out of a lattice, whose borders are smooth but have edges where the lattice has them: depths against
// closed forms.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <numbers>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "common/field/analytic/ventricle.h"
#include "common/field/field_grid.h"
#include "common/field/layer/wall_layer.h"
#include "common/field/layer/wall_surfaces.h"
#include "tests/support/carved_wall.h"

namespace palpate {
namespace {

/// About the distance to an ellipsoid, below zero in it.
double ellipsoid(const Vec3& x, const Vec3& middle, const Vec3& axes) {
  const Vec3 part = (x - middle) / axes;
  const double k = glm::length(part), slope = glm::length(part / axes);
  return slope > 0.0 ? (k - 1.0) * k / slope : -std::min({axes.x, axes.y, axes.z});
}
/// The lower one, rounded where both are within `round` of each other.
double smooth_min(double a, double b, double round) {
  const double h = round > 0.0 ? std::max(round - std::abs(a - b), 0.0) / round : 0.0;
  return std::min(a, b) - h * h * round / 4.0;
}

constexpr double kInner = 20.0, kOuter = 30.0, kCube = 2.5;

/// Two ventricles with the base at z = 0: a left one between spheres, and the wall of an ellipsoid that stands on it.
struct TwoShells {
  Vec3 middle;  ///< of the right ventricle
  double round = 0.0;

  static constexpr Vec3 kCavity{28.0, 24.0, 27.0}, kWall{33.0, 29.0, 32.0};

  [[nodiscard]] double operator()(const Vec3& x) const {
    const double r = glm::length(x);
    const double right = std::max(ellipsoid(x, middle, kWall), -ellipsoid(x, middle, kCavity));
    return std::max({kInner - r, smooth_min(r - kOuter, right, round), x.z});
  }
  /// The area of the outer sphere that the right cavity lies on, by the midpoints of patches.
  [[nodiscard]] double septum() const {
    constexpr int kParts = 400;
    double sum = 0.0;
    for (int i = 0; i < kParts; ++i)
      for (int j = 0; j < kParts; ++j) {
        const double z = -(i + 0.5) / kParts, around = 2.0 * std::numbers::pi * (j + 0.5) / kParts,
                     across = std::sqrt(1.0 - z * z);
        const Vec3 x = kOuter * Vec3{across * std::cos(around), across * std::sin(around), z};
        if (ellipsoid(x, middle, kCavity) < 0.0)
          sum += 2.0 * std::numbers::pi * kOuter * kOuter / kParts / kParts;
      }
    return sum;
  }
};

struct Worst {
  double septum = 0.0, free = 0.0, at_base = 0.0;
  std::size_t places = 0;
};

// Smooth and carved, such walls have no crease around their cavities that a part could end at: whatever leads from one
// surface to another makes one of them, which depths do not survive.
TEST(SmoothShells, DepthsOfBothVentriclesAreThePotentialBetweenSpheres) {
  for (const double round : {0.0, 3.0, 6.0})
    for (const double out : {16.0, 20.0, 24.0, 28.0, 32.0, 40.0}) {
      const TwoShells shells{.middle = {out, 0.0, 0.0}, .round = round};
      const test::CarvedWall carved(shells, Vec3{-31.3, -31.3, -34.1}, Vec3{out + 36.0, 33.0, 1.0}, kCube);
      const auto grid = make_field_grid(std::span(&carved.mesh, 1), "shells", 1);
      const WallSurfaces surfaces = find_wall_surfaces(*grid, carved.mesh, "shells");
      const WallLayer layer = make_wall_layer(*grid, carved.mesh, "shells", 1);
      std::string what = std::to_string(round) + " " + std::to_string(out);
      for (const std::string& note : layer.notes) what += "\n" + note;
      Worst worst;
      const DataArray& x = std::get<UnstructuredTopology>(carved.mesh.topology).positions;
      for (std::size_t p = 0; p < layer.array.tuples; ++p) {
        const Vec3 at{x.at(p, 0), x.at(p, 1), x.at(p, 2)};
        const double r = glm::length(at);
        if (r > kOuter + 1e-9) continue;
        const double off =
            std::abs(layer.array.at(p) - (1.0 / kInner - 1.0 / r) / (1.0 / kInner - 1.0 / kOuter));
        // The form holds where the outer side is the sphere for a wall's thickness around.
        const Vec3 outward = kOuter / r * at;
        const bool septum = ellipsoid(outward, shells.middle, TwoShells::kCavity) < -1.2 * (kOuter - kInner);
        const bool free = ellipsoid(outward, shells.middle, TwoShells::kWall) > 2.0 * (kOuter - kInner);
        if (!septum && !free) continue;
        ++worst.places;
        worst.at_base = std::max(worst.at_base, off);
        if (at.z < -(kOuter - kInner))
          (septum ? worst.septum : worst.free) = std::max(septum ? worst.septum : worst.free, off);
      }
      EXPECT_GT(worst.places, 60U) << what;
      EXPECT_LT(worst.septum, 0.04) << what;
      EXPECT_LT(worst.free, 0.02) << what;
      // Where the edge of the base lies is known to a cube, a quarter of the wall.
      EXPECT_LT(worst.at_base, kCube / (kOuter - kInner)) << what;
      EXPECT_EQ(surfaces.pieces[static_cast<std::size_t>(BorderRole::kSeptum)], 1U) << what;
      EXPECT_EQ(surfaces.pieces[static_cast<std::size_t>(BorderRole::kInner)], 1U) << what;
      // The edge of the base takes a strip of it, and fillets what they round.
      EXPECT_NEAR(surfaces.areas[static_cast<std::size_t>(BorderRole::kSeptum)] / shells.septum(), 1.0,
                  0.2 + 0.03 * round)
          << what;
    }
}

// The left ventricle alone, between ellipsoids of one pair of foci, with a rim of any height.
TEST(SmoothShells, DepthsOfAVentricleWithAnyRimAreTheClosedForm) {
  const Ventricle shape;
  const double inner = shape.potential(shape.lambda_inner), outer = shape.potential(shape.lambda_outer);
  const std::vector<std::pair<std::string, std::function<double(double)>>> rims{
      {"flat", [](double) { return 0.0; }},
      {"slanted", [](double theta) { return 0.5 * std::cos(theta); }},
      {"saddle", [](double theta) { return 0.5 * std::cos(2.0 * theta); }},
      {"three lobes", [](double theta) { return 0.5 * std::sin(3.0 * theta); }}};
  for (const auto& [name, rim] : rims)
    for (const double size : {0.06, 0.12, 0.2}) {
      const double high = 1.0 - std::cos(shape.mu_base);
      const auto wall = [&, &lift = rim](const Vec3& x) {
        const Prolate at = shape.coordinates(x);
        const double base = std::acos(std::clamp(1.0 - high * (1.0 + size * lift(at.theta)), -1.0, 1.0));
        const double scale = shape.focus * std::hypot(std::sinh(at.lambda), std::sin(at.mu));
        return scale *
               std::max({shape.lambda_inner - at.lambda, at.lambda - shape.lambda_outer, at.mu - base});
      };
      const test::CarvedWall carved(wall, Vec3{-37.3, -37.3, -55.1}, Vec3{37.0, 37.0, 36.0}, kCube);
      const WallLayer layer = make_wall_layer(carved.mesh, "ventricle", 1);
      std::string what = name + " " + std::to_string(size);
      for (const std::string& note : layer.notes) what += "\n" + note;
      double worst = 0.0, at_rim = 0.0;
      const DataArray& x = std::get<UnstructuredTopology>(carved.mesh.topology).positions;
      for (std::size_t p = 0; p < layer.array.tuples; ++p) {
        const Prolate at = shape.coordinates({x.at(p, 0), x.at(p, 1), x.at(p, 2)});
        const double off =
            std::abs(layer.array.at(p) - (shape.potential(at.lambda) - inner) / (outer - inner));
        at_rim = std::max(at_rim, off);
        if (at.mu < 1.0) worst = std::max(worst, off);
      }
      EXPECT_LT(worst, 0.03) << what;
      EXPECT_LT(at_rim, 0.5) << what;
    }
}

}  // namespace
}  // namespace palpate
