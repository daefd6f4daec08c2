#include "loaders/cardiac/ex/ex_places.h"

#include <algorithm>
#include <map>

#include "common/base/index.h"

namespace palpate::ex {
namespace {

using Index = std::array<int, 3>;

constexpr std::uint8_t kTetrahedron = 10, kHexahedron = 12, kWedge = 13;

struct Numbered {
  ElementPlaces places;
  std::map<Index, std::size_t> number;
};

/// @param sum of the linked axes' numbers at most `refine`.
Numbered numbered(const Linked& linked, int refine) {
  Numbered made;
  for (int k = 0; k <= refine; ++k) {
    for (int j = 0; j <= refine; ++j) {
      for (int i = 0; i <= refine; ++i) {
        const Index at{i, j, k};
        int sum = 0;
        bool inside = true;
        for (std::size_t a = 0; a < 3; ++a) {
          sum += linked[a] ? at[a] : 0;
          inside = inside && at[a] > 0 && at[a] < refine;
        }
        if (sum > refine) continue;
        if (linked != Linked{}) inside = inside && sum < refine;
        made.number[at] = made.places.xi.size();
        made.places.xi.push_back(Vec3(i, j, k) / static_cast<double>(refine));
        made.places.inside.push_back(inside);
      }
    }
  }
  for (const auto& [at, number] : made.number) {
    for (std::size_t a = 0; a < 3; ++a) {
      Index next = at;
      ++next[a];
      if (const auto found = made.number.find(next); found != made.number.end())
        made.places.edges.emplace_back(number, found->second);
    }
  }
  return made;
}

/// Adds a cell where all its corners are places.
void add(Numbered& made, const std::vector<Index>& corners) {
  for (const Index& corner : corners)
    if (!made.number.contains(corner)) return;
  for (const Index& corner : corners) made.places.corners.push_back(made.number.at(corner));
}

Index moved(const Index& from, const Index& by) {
  return {from[0] + by[0], from[1] + by[1], from[2] + by[2]};
}

void add_tetrahedra(Numbered& made, const Index& at) {
  // One that stands as the element does, four about an axis of the octahedron between, one upside down.
  static constexpr std::array<std::array<Index, 4>, 6> kCells{
      {{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}},
       {{{1, 0, 0}, {0, 1, 1}, {0, 1, 0}, {1, 1, 0}}},
       {{{1, 0, 0}, {0, 1, 1}, {1, 1, 0}, {1, 0, 1}}},
       {{{1, 0, 0}, {0, 1, 1}, {1, 0, 1}, {0, 0, 1}}},
       {{{1, 0, 0}, {0, 1, 1}, {0, 0, 1}, {0, 1, 0}}},
       {{{1, 1, 0}, {1, 0, 1}, {0, 1, 1}, {1, 1, 1}}}}};
  for (const auto& cell : kCells) {
    std::vector<Index> corners;
    for (const Index& corner : cell) corners.push_back(moved(at, corner));
    const auto edge = [&](std::size_t n) {
      return Vec3(cell[n][0] - cell[0][0], cell[n][1] - cell[0][1], cell[n][2] - cell[0][2]);
    };
    if (glm::dot(glm::cross(edge(1), edge(2)), edge(3)) < 0.0) std::swap(corners[2], corners[3]);
    add(made, corners);
  }
}

/// @param free the axis that is not linked.
void add_wedges(Numbered& made, const Index& at, std::size_t free) {
  const std::size_t first = (free + 1) % 3, second = (free + 2) % 3;  // first, second, free: right-handed
  const auto corner = [&](int a, int b, int c) {
    Index by{};
    by[first] = a;
    by[second] = b;
    by[free] = c;
    return moved(at, by);
  };
  add(made,
      {corner(0, 0, 0), corner(1, 0, 0), corner(0, 1, 0), corner(0, 0, 1), corner(1, 0, 1), corner(0, 1, 1)});
  add(made,
      {corner(1, 0, 0), corner(1, 1, 0), corner(0, 1, 0), corner(1, 0, 1), corner(1, 1, 1), corner(0, 1, 1)});
}

}  // namespace

ElementPlaces element_places(const Linked& linked, int refine) {
  Numbered made = numbered(linked, refine);
  const auto axes = std::count(linked.begin(), linked.end(), true);
  made.places.type = axes == 3 ? kTetrahedron : axes == 2 ? kWedge : kHexahedron;
  made.places.corner_count = axes == 3 ? 4 : axes == 2 ? 6 : 8;
  const auto free = as_size(std::find(linked.begin(), linked.end(), false) - linked.begin());
  for (int k = 0; k < refine; ++k) {
    for (int j = 0; j < refine; ++j) {
      for (int i = 0; i < refine; ++i) {
        const Index at{i, j, k};
        if (axes == 3) add_tetrahedra(made, at);
        if (axes == 2) add_wedges(made, at, free);
        if (axes == 0)
          add(made, {at, moved(at, {1, 0, 0}), moved(at, {1, 1, 0}), moved(at, {0, 1, 0}),
                     moved(at, {0, 0, 1}), moved(at, {1, 0, 1}), moved(at, {1, 1, 1}), moved(at, {0, 1, 1})});
      }
    }
  }
  return std::move(made.places);
}

std::string cells_text(const Linked& linked, int refine) {
  const std::string side = std::to_string(refine);
  const auto axes = std::count(linked.begin(), linked.end(), true);
  if (axes == 0) return side + " x " + side + " x " + side + " hexahedra";
  const std::string count = std::to_string(refine * refine * refine);
  return count +
         (axes == 3 ? (refine == 1 ? " tetrahedron" : " tetrahedra") : (refine == 1 ? " wedge" : " wedges"));
}

std::pair<Vec3, double> from_cube(const Linked& linked, Vec3 xi) {
  // Each linked axis takes its part of what those before it leave.
  double left = 1.0, volume = 1.0;
  bool first = true;
  for (std::size_t a = 0; a < 3; ++a) {
    if (!linked[a]) continue;
    double& x = xi[static_cast<int>(a)];
    x *= left;
    if (!first) volume *= left;
    first = false;
    left -= x;
  }
  return {xi, volume};
}

}  // namespace palpate::ex
