/// Walls carved out of a lattice: the mesh of where a function is below zero, with a smooth border.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "common/field/data_set.h"
#include "common/math/vec.h"

namespace palpate::test {

/// Below zero in the wall, about the distance to its border near it.
using WallFunction = std::function<double(const Vec3&)>;

/// Tetrahedra of the lattice's cubes, six each, cut at the border. Points closer to it than a quarter of an edge are moved
/// onto it, so that few cells are flat.
class CarvedWall {
 public:
  /// @param size of a cube.
  CarvedWall(const WallFunction& wall, const Vec3& low, const Vec3& high, double size) : wall_(wall) {
    const glm::dvec3 cubes = glm::ceil((high - low) / size);
    const std::array<int, 3> n{static_cast<int>(cubes.x), static_cast<int>(cubes.y),
                               static_cast<int>(cubes.z)};
    const auto at = [n](int i, int j, int k) {
      return static_cast<std::size_t>(i + (n[0] + 1) * (j + (n[1] + 1) * k));
    };
    for (int k = 0; k <= n[2]; ++k)
      for (int j = 0; j <= n[1]; ++j)
        for (int i = 0; i <= n[0]; ++i) {
          places_.push_back(low + size * Vec3{i, j, k});
          values_.push_back(wall_(places_.back()));
        }
    std::vector<std::array<std::size_t, 4>> tets;
    for (int k = 0; k < n[2]; ++k)
      for (int j = 0; j < n[1]; ++j)
        for (int i = 0; i < n[0]; ++i)
          for (const auto& order : std::array<std::array<std::size_t, 3>, 6>{
                   {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {1, 0, 2}, {0, 2, 1}, {2, 1, 0}}}) {
            std::array<int, 3> place{i, j, k};
            std::array<std::size_t, 4> tet{at(i, j, k)};
            for (std::size_t c = 0; c < 3; ++c) {
              ++place[order[c]];
              tet[c + 1] = at(place[0], place[1], place[2]);
            }
            tets.push_back(tet);
          }
    move_to_border(tets);
    for (const auto& tet : tets) cut(tet);
    UnstructuredTopology topology;
    topology.positions = make_array("points", Association::kPoint, 3, std::span<const double>(x_));
    for (std::size_t c = 0; c <= cells_.size() / 4; ++c)
      topology.offsets.push_back(static_cast<std::int64_t>(4 * c));
    topology.types.assign(cells_.size() / 4, 10);
    topology.connectivity = std::move(cells_);
    mesh.topology = std::move(topology);
  }

  DataSet mesh;

 private:
  using Ends = std::pair<std::size_t, std::size_t>;

  /// Where the border cuts an edge, as the part of the way, by halving.
  [[nodiscard]] double crossing(std::size_t a, std::size_t b) const {
    double low = 0.0, high = 1.0;
    constexpr int kHalvings = 40;
    for (int i = 0; i < kHalvings; ++i) {
      const double middle = 0.5 * (low + high);
      ((wall_(glm::mix(places_[a], places_[b], middle)) < 0.0) == (values_[a] < 0.0) ? low : high) = middle;
    }
    return 0.5 * (low + high);
  }

  void move_to_border(const std::vector<std::array<std::size_t, 4>>& tets) {
    constexpr double kNear = 0.25;  // of an edge
    std::map<std::size_t, std::pair<double, Vec3>> moved;
    std::map<Ends, double> seen;
    for (const auto& tet : tets)
      for (const std::size_t a : tet)
        for (const std::size_t b : tet) {
          if (a >= b || (values_[a] < 0.0) == (values_[b] < 0.0) || seen.contains({a, b})) continue;
          const double part = crossing(a, b);
          seen[{a, b}] = part;
          const Vec3 place = glm::mix(places_[a], places_[b], part);
          for (const auto& [point, away] : {std::pair(a, part), std::pair(b, 1.0 - part)}) {
            const double length = away * glm::distance(places_[a], places_[b]);
            const auto found = moved.find(point);
            if (away < kNear && (found == moved.end() || length < found->second.first))
              moved[point] = {length, place};
          }
        }
    for (const auto& [point, to] : moved) {
      places_[point] = to.second;
      values_[point] = 0.0;
    }
  }

  std::int64_t number(std::size_t a, std::size_t b) {
    const auto [found, is_new] =
        numbers_.try_emplace(std::minmax(a, b), static_cast<std::int64_t>(x_.size() / 3));
    if (is_new) {
      const Vec3 x = a == b ? places_[a] : glm::mix(places_[a], places_[b], crossing(a, b));
      x_.insert(x_.end(), {x.x, x.y, x.z});
    }
    return found->second;
  }

  /// Keeps what of a tetrahedron is in the wall: one, or a prism of three by the smallest number of each side.
  void cut(const std::array<std::size_t, 4>& tet) {
    std::vector<std::size_t> in, out;
    for (const std::size_t p : tet) (values_[p] < 0.0 ? in : out).push_back(p);
    const auto edge = [&](std::size_t a, std::size_t b) {
      return values_[b] == 0.0 ? number(b, b) : number(a, b);
    };
    const auto corner = [&](std::size_t a) { return number(a, a); };
    if (in.size() == 4) add({corner(in[0]), corner(in[1]), corner(in[2]), corner(in[3])});
    if (in.size() == 1) add({corner(in[0]), edge(in[0], out[0]), edge(in[0], out[1]), edge(in[0], out[2])});
    if (in.size() == 2)
      add_prism({corner(in[0]), edge(in[0], out[0]), edge(in[0], out[1]), corner(in[1]), edge(in[1], out[0]),
                 edge(in[1], out[1])});
    if (in.size() == 3)
      add_prism({corner(in[0]), corner(in[1]), corner(in[2]), edge(in[0], out[0]), edge(in[1], out[0]),
                 edge(in[2], out[0])});
  }
  /// Corners 0 1 2 and across from them 3 4 5. The diagonals of sides start at their smallest number, so that neighbours
  /// agree (Dompierre et al. 1999).
  void add_prism(std::array<std::int64_t, 6> p) {
    const auto least = static_cast<std::size_t>(std::min_element(p.begin(), p.end()) - p.begin());
    const std::array<std::size_t, 6> turned =
        least < 3 ? std::array<std::size_t, 6>{least,     (least + 1) % 3,     (least + 2) % 3,
                                               3 + least, 3 + (least + 1) % 3, 3 + (least + 2) % 3}
                  : std::array<std::size_t, 6>{least,     3 + (least + 1) % 3, 3 + (least + 2) % 3,
                                               least - 3, (least + 1) % 3,     (least + 2) % 3};
    std::array<std::int64_t, 6> q{};
    for (std::size_t i = 0; i < 6; ++i) q[i] = p[turned[i]];
    add({q[0], q[3], q[4], q[5]});
    if (std::min(q[1], q[5]) < std::min(q[2], q[4])) {
      add({q[0], q[1], q[2], q[5]});
      add({q[0], q[1], q[5], q[4]});
    } else {
      add({q[0], q[1], q[2], q[4]});
      add({q[0], q[4], q[2], q[5]});
    }
  }
  void add(const std::array<std::int64_t, 4>& tet) {
    for (std::size_t a = 0; a < 4; ++a)
      for (std::size_t b = 0; b < a; ++b)
        if (tet[a] == tet[b]) return;
    cells_.insert(cells_.end(), tet.begin(), tet.end());
  }

  WallFunction wall_;
  std::vector<Vec3> places_;
  std::vector<double> values_;
  std::map<Ends, std::int64_t> numbers_;
  std::vector<double> x_;
  std::vector<std::int64_t> cells_;
};

}  // namespace palpate::test
