// Surfaces of walls by their shape: rims that are not flat, two ventricles. What is right is known from how each
// mesh was made.
#include "common/field/layer/wall_surfaces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <random>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/field/analytic/ventricle.h"
#include "common/field/field_grid.h"
#include "common/field/layer/wall_layer.h"

namespace palpate {
namespace {

constexpr double kPi = std::numbers::pi;

/// A ventricle whose points above half its height are moved along its axis: by `rim` of its angle at the base.
/// @param rim in parts of the height. @param tags whether the mesh says what its surfaces are.
DataSet with_rim(const std::function<double(double)>& rim, bool tags, double mu_base) {
  Ventricle shape;
  shape.mu_base = mu_base;
  DataSet mesh = ventricle_mesh(shape, {.wall = 4, .along = 14, .around = 36});
  auto& topology = std::get<UnstructuredTopology>(mesh.topology);
  std::vector<double> x;
  double low = 0.0, high = -1e300;
  for (std::size_t p = 0; p < topology.positions.tuples; ++p) {
    low = std::min(low, topology.positions.at(p, 2));
    high = std::max(high, topology.positions.at(p, 2));
  }
  const double height = high - low;
  for (std::size_t p = 0; p < topology.positions.tuples; ++p) {
    const Vec3 at{topology.positions.at(p, 0), topology.positions.at(p, 1), topology.positions.at(p, 2)};
    const Prolate place = shape.coordinates(at);
    const double part = std::max(0.0, 2.0 * place.mu / mu_base - 1.0);
    x.insert(x.end(), {at.x, at.y, at.z + height * part * part * rim(place.theta)});
  }
  topology.positions = make_array("points", Association::kPoint, 3, std::span<const double>(x));
  std::erase_if(mesh.arrays, [&](const DataArray& array) { return !tags || array.name != kSurfaceArray; });
  return mesh;
}

std::string text_of(const WallLayer& layer) {
  std::string text;
  for (const std::string& note : layer.notes) text += note + "\n";
  return text;
}

// The base has no say, so that layers are those of the mesh that names its surfaces.
TEST(WallSurfacesByShape, RimsOfAnyShapeStayFree) {
  std::mt19937 random(23);
  std::uniform_real_distribution<double> any(-0.5, 0.5);
  std::map<int, double> jags;
  for (int n = -20; n <= 20; ++n) jags[n] = any(random);
  const std::map<std::string, std::function<double(double)>> rims{
      {"slanted", [](double theta) { return 0.5 * std::cos(theta); }},
      {"saddle", [](double theta) { return 0.5 * std::cos(2.0 * theta); }},
      {"three lobes", [](double theta) { return 0.5 * std::sin(3.0 * theta); }},
      {"teeth", [](double theta) { return std::lround(theta * 18.0 / kPi) % 2 == 0 ? 0.5 : -0.5; }},
      {"jagged", [&](double theta) { return jags.at(static_cast<int>(std::lround(theta * 18.0 / kPi))); }}};
  for (const auto& [name, rim] : rims) {
    for (const double mu_base : {0.5 * kPi, 1.9}) {
      for (const double size : {0.0, 0.06, 0.12, 0.2}) {
        const auto scaled = [size, &shape = rim](double theta) { return size * shape(theta); };
        const WallLayer found = make_wall_layer(with_rim(scaled, false, mu_base), "heart");
        const WallLayer named = make_wall_layer(with_rim(scaled, true, mu_base), "heart");
        double worst = 0.0;
        for (std::size_t p = 0; p < found.array.tuples; ++p)
          worst = std::max(worst, std::abs(found.array.at(p) - named.array.at(p)));
        EXPECT_LT(worst, 1e-6) << name << " " << size << " " << mu_base << "\n" << text_of(found);
      }
    }
  }
}

/// Two ventricles about the z axis, apex below. The left one is half a shell of radii 1 and 1.5; the right
/// one's wall stands on it over `angle` around and the upper part, 0.3 thick, with a cavity between.
class TwoVentricles {
 public:
  static constexpr int kAround = 72, kAlong = 18, kThrough = 4;

  explicit TwoVentricles(double angle) : half_(0.5 * angle) {
    const auto left = [&](int i, int j, int k) {
      return point(0, j == 0 ? 0 : wrapped(i), j, k, at(i, j, 1.0 + 0.5 * k / kThrough));
    };
    for (int i = 0; i < kAround; ++i)
      for (int j = 0; j < kAlong; ++j)
        for (int k = 0; k < kThrough; ++k) add_cell(left, i, j, k);
    const auto right = [&](int i, int j, int k) {
      const double gap = gap_at(i, j), thick = thickness_at(i, j);
      // Where there is no gap it stands on the left one, where it has no thickness it ends.
      if (gap == 0.0 && (k == 0 || thick == 0.0)) return left(i, j, kThrough);
      return point(1, wrapped(i), j, k, at(i, j, 1.5 + gap + thick * k / kThrough));
    };
    for (int i = 0; i < kAround; ++i)
      for (int j = 0; j < kAlong; ++j)
        for (int k = 0; k < kThrough; ++k)
          if (thickness_at(i, j) + thickness_at(i + 1, j) + thickness_at(i, j + 1) +
                  thickness_at(i + 1, j + 1) >
              0.0)
            add_cell(right, i, j, k);
    UnstructuredTopology topology;
    topology.positions = make_array("points", Association::kPoint, 3, std::span<const double>(x_));
    topology.connectivity = cells_;
    for (std::size_t c = 0; c <= cells_.size() / 4; ++c)
      topology.offsets.push_back(static_cast<std::int64_t>(4 * c));
    topology.types.assign(cells_.size() / 4, 10);
    mesh.topology = std::move(topology);
  }

  /// The depth at a point of the left (0) or the right (1) wall.
  [[nodiscard]] double depth(const WallLayer& layer, int wall, int i, int j, int k) const {
    return layer.array.at(static_cast<std::size_t>(points_.at({wall, i, j, k})));
  }
  /// Of the right cavity: 0 where there is none.
  [[nodiscard]] double gap_at(int i, int j) const {
    const double around = (half_ - std::abs(angle_of(i)) - 2.0 * kStep) / (0.35 * half_);
    const double along = (kPi / 2.0 * j / kAlong - 0.6) / 0.3;
    return 0.8 * std::sqrt(std::clamp(around, 0.0, 1.0) * std::clamp(along, 0.0, 1.0));
  }

  DataSet mesh;

 private:
  static constexpr double kStep = 2.0 * kPi / kAround;

  static int wrapped(int i) { return (i + kAround) % kAround; }
  static double angle_of(int i) { return std::remainder(kStep * i, 2.0 * kPi); }
  [[nodiscard]] double thickness_at(int i, int j) const {
    const double around = (half_ - std::abs(angle_of(i))) / (2.0 * kStep);
    const double along = (kPi / 2.0 * j / kAlong - 0.35) / 0.2;
    return 0.3 * std::clamp(around, 0.0, 1.0) * std::clamp(along, 0.0, 1.0);
  }
  static Vec3 at(int i, int j, double r) {
    const double polar = kPi / 2.0 * j / kAlong, around = angle_of(i);
    return r * Vec3{std::sin(polar) * std::cos(around), std::sin(polar) * std::sin(around),
                    -1.4 * std::cos(polar)};
  }
  std::int64_t point(int wall, int i, int j, int k, const Vec3& x) {
    const auto [found, is_new] =
        points_.try_emplace({wall, i, j, k}, static_cast<std::int64_t>(x_.size() / 3));
    if (is_new) x_.insert(x_.end(), {x.x, x.y, x.z});
    return found->second;
  }
  /// Six tetrahedra about the diagonal of a cell; those with two equal corners are left out.
  template <typename Corner>
  void add_cell(const Corner& corner, int i, int j, int k) {
    static constexpr std::array<std::array<int, 3>, 6> kOrders{
        {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {1, 0, 2}, {0, 2, 1}, {2, 1, 0}}};
    for (const auto& order : kOrders) {
      std::array<int, 3> place{i, j, k};
      std::array<std::int64_t, 4> tet{corner(i, j, k)};
      for (std::size_t n = 0; n < 3; ++n) {
        ++place[static_cast<std::size_t>(order[n])];
        tet[n + 1] = corner(place[0], place[1], place[2]);
      }
      bool proper = true;
      for (std::size_t a = 0; a < 4; ++a)
        for (std::size_t b = 0; b < a; ++b) proper = proper && tet[a] != tet[b];
      if (proper) cells_.insert(cells_.end(), tet.begin(), tet.end());
    }
  }

  double half_;
  std::map<std::array<int, 4>, std::int64_t> points_;
  std::vector<double> x_;
  std::vector<std::int64_t> cells_;
};

TEST(WallSurfacesByShape, TheSeptumRunsFromOneVentricleToTheOther) {
  for (const double degrees : {70.0, 90.0, 110.0, 130.0, 150.0, 170.0}) {
    const TwoVentricles heart(degrees * kPi / 180.0);
    const WallLayer layer = make_wall_layer(heart.mesh, "heart");
    const std::string notes = text_of(layer);
    EXPECT_NE(notes.find("septum on the right"), std::string::npos) << degrees << notes;
    EXPECT_EQ(notes.find("WARNING"), std::string::npos) << degrees << notes;
    std::size_t columns = 0, rising = 0, septum = 0, right = 0, right_rising = 0;
    for (int i = 0; i < TwoVentricles::kAround; ++i) {
      for (int j = 1; j < TwoVentricles::kAlong; ++j) {
        const auto rises = [&](int wall) {
          bool up = heart.depth(layer, wall, i, j, 0) == 0.0;
          for (int k = 1; k <= TwoVentricles::kThrough; ++k)
            up = up && heart.depth(layer, wall, i, j, k) > heart.depth(layer, wall, i, j, k - 1);
          return up && heart.depth(layer, wall, i, j, TwoVentricles::kThrough) == 1.0;
        };
        if (heart.gap_at(i, j) > 0.0) {
          ++septum;
          EXPECT_TRUE(rises(0)) << degrees << " septum " << i << " " << j;
          ++right;
          right_rising += rises(1) ? 1 : 0;
        }
        // Where the right wall stands on the left one the wall goes on.
        ++columns;
        rising += heart.depth(layer, 0, i, j, 0) == 0.0 && heart.depth(layer, 0, i, j, 1) > 0.0 ? 1 : 0;
      }
    }
    EXPECT_GT(septum, 40U) << degrees;
    EXPECT_EQ(rising, columns) << degrees;
    EXPECT_EQ(right_rising, right) << degrees;
  }
}

}  // namespace
}  // namespace palpate
