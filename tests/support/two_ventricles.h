/// Two ventricles as a mesh of tetrahedra, made by formula.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

#include "common/field/data_set.h"
#include "common/field/layer/wall_layer.h"

namespace palpate::test {

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
    return layer.array.at(point_at(wall, i, j, k));
  }
  /// The number of that point. @throws std::out_of_range where there is none.
  [[nodiscard]] std::size_t point_at(int wall, int i, int j, int k) const {
    return static_cast<std::size_t>(points_.at({wall, i, j, k}));
  }
  /// Of the right cavity: 0 where there is none.
  [[nodiscard]] double gap_at(int i, int j) const {
    const double around = (half_ - std::abs(angle_of(i)) - 2.0 * kStep) / (0.35 * half_);
    const double along = (std::numbers::pi / 2.0 * j / kAlong - 0.6) / 0.3;
    return 0.8 * std::sqrt(std::clamp(around, 0.0, 1.0) * std::clamp(along, 0.0, 1.0));
  }

  DataSet mesh;

 private:
  static constexpr double kStep = 2.0 * std::numbers::pi / kAround;

  static int wrapped(int i) { return (i + kAround) % kAround; }
  static double angle_of(int i) { return std::remainder(kStep * i, 2.0 * std::numbers::pi); }
  [[nodiscard]] double thickness_at(int i, int j) const {
    const double around = (half_ - std::abs(angle_of(i))) / (2.0 * kStep);
    const double along = (std::numbers::pi / 2.0 * j / kAlong - 0.35) / 0.2;
    return 0.3 * std::clamp(around, 0.0, 1.0) * std::clamp(along, 0.0, 1.0);
  }
  static Vec3 at(int i, int j, double r) {
    const double polar = std::numbers::pi / 2.0 * j / kAlong, around = angle_of(i);
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

}  // namespace palpate::test
