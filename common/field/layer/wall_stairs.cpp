#include "common/field/layer/wall_stairs.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <span>
#include <utility>

#include "common/base/disjoint_sets.h"
#include "common/base/index.h"

namespace palpate {
namespace {

constexpr double kAcross = 0.9995;    // cosine between a normal and the axis that it is along
constexpr double kMostAcross = 0.98;  // of the border's area
constexpr double kMostVoxels = 3e7;
constexpr int kDirections = 26;
constexpr int kDeep = 20;              // of them end in the wall, deep in a cavity
constexpr int kWithin = 14;            // and anywhere in it: in a plane rim half of them do
constexpr double kSmallCavity = 0.02;  // of the wall's volume
constexpr int kRounds = 24;            // of means: some three voxels far
constexpr double kFacesUp = 0.7;       // the mean normal half way between a rim and the wall beside it

/// Three axes at right angles, and the planes of the border's points along each.
struct Lattice {
  Mat3 axes{1.0};  ///< columns
  Vec3 origin{0.0}, step{0.0};
  std::array<int, 3> count{};  ///< of voxels, with an empty one at either end

  [[nodiscard]] std::size_t size() const { return as_size(count[0]) * as_size(count[1]) * as_size(count[2]); }
  [[nodiscard]] std::size_t index(int i, int j, int k) const {
    return as_size(i) + as_size(count[0]) * (as_size(j) + as_size(count[1]) * as_size(k));
  }
  /// The voxel of a place, or none.
  [[nodiscard]] std::optional<std::size_t> at(const Vec3& x) const {
    std::array<int, 3> place{};
    for (int a = 0; a < 3; ++a) {
      const double part = std::floor((glm::dot(x, axes[a]) - origin[a]) / step[a]);
      if (!(part >= 0.0 && part < count[as_size(a)])) return std::nullopt;
      place[as_size(a)] = static_cast<int>(part);
    }
    return index(place[0], place[1], place[2]);
  }
  [[nodiscard]] Vec3 center(int i, int j, int k) const {
    const Vec3 along = origin + step * Vec3{i + 0.5, j + 0.5, k + 0.5};
    return along[0] * axes[0] + along[1] * axes[1] + along[2] * axes[2];
  }
};

/// The axes that the border lies across; false where it does not.
bool find_axes(const WallBorder& border, Mat3& axes) {
  const auto largest = [&](const auto& fits) -> std::optional<Vec3> {
    double most = 0.0;
    std::optional<Vec3> found;
    for (std::size_t t = 0; t < border.areas.size(); ++t) {
      const double area = glm::length(border.areas[t]);
      if (!(area > most) || !fits(border.areas[t] / area)) continue;
      most = area;
      found = border.areas[t] / area;
    }
    return found;
  };
  const auto first = largest([](const Vec3&) { return true; });
  if (!first) return false;
  const auto second = largest(
      [&](const Vec3& n) { return std::abs(glm::dot(n, *first)) < std::sqrt(1.0 - kAcross * kAcross); });
  if (!second) return false;
  axes[0] = *first;
  axes[2] = glm::normalize(glm::cross(*first, *second));
  axes[1] = glm::cross(axes[2], axes[0]);
  double across = 0.0, all = 0.0;
  for (const Vec3& area : border.areas) {
    const double length = glm::length(area);
    all += length;
    for (int a = 0; a < 3; ++a)
      if (std::abs(glm::dot(area, axes[a])) > kAcross * length) across += length;
  }
  return across > kMostAcross * all;
}

/// Whether the border's points lie on planes that are a step apart.
bool find_planes(std::span<const Vec3> points, const WallBorder& border, Lattice& lattice) {
  constexpr double kSame = 1e-4;      // of the extent
  constexpr double kOffPlane = 0.02;  // of a step
  double voxels = 1.0;
  for (int a = 0; a < 3; ++a) {
    std::vector<double> along;
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const auto& triangle : border.triangles) {
      for (const std::uint32_t p : triangle) {
        along.push_back(glm::dot(points[p], lattice.axes[a]));
        low = std::min(low, along.back());
        high = std::max(high, along.back());
      }
    }
    std::sort(along.begin(), along.end());
    const double extent = high - low;
    double step = extent;
    for (std::size_t i = 1; i < along.size(); ++i)
      if (const double gap = along[i] - along[i - 1]; gap > kSame * extent) step = std::min(step, gap);
    if (!(step > 0.0)) return false;
    // The mean over all of them, as the smallest is that with the most rounding.
    const double steps = std::round(extent / step);
    voxels *= steps + 2.0;
    if (!(voxels < kMostVoxels)) return false;
    step = extent / steps;
    std::size_t off = 0;
    for (const double x : along) {
      const double part = (x - low) / step;
      off += std::abs(part - std::round(part)) > kOffPlane ? 1 : 0;
    }
    if (static_cast<double>(off) > (1.0 - kMostAcross) * static_cast<double>(along.size())) return false;
    lattice.step[a] = step;
    lattice.origin[a] = low - step;
    lattice.count[as_size(a)] = static_cast<int>(steps) + 2;
  }
  return true;
}

/// Which voxels are wall.
std::vector<std::uint8_t> wall_of(const TetMesh& mesh, const Lattice& lattice) {
  std::vector<std::uint8_t> wall(lattice.size(), 0);
  TetPoint found;
  for (int k = 1; k + 1 < lattice.count[2]; ++k)
    for (int j = 1; j + 1 < lattice.count[1]; ++j)
      for (int i = 1; i + 1 < lattice.count[0]; ++i)
        if (mesh.locate(lattice.center(i, j, k), found.cell, found)) wall[lattice.index(i, j, k)] = 1;
  return wall;
}

/// In how many of the directions to its neighbours a voxel has wall before it, at any distance.
std::vector<std::uint8_t> enclosure_of(const std::vector<std::uint8_t>& wall, const Lattice& lattice) {
  std::vector<std::uint8_t> count(wall.size(), 0), before(wall.size());
  const auto [nx, ny, nz] = lattice.count;
  for (int direction = 0; direction <= kDirections; ++direction) {
    const std::array<int, 3> d{direction % 3 - 1, direction / 3 % 3 - 1, direction / 9 - 1};
    if (d == std::array<int, 3>{}) continue;
    // From the side that the direction leads to: what is before a voxel is known when it is reached.
    const auto from = [](int step, int n, int at) { return step > 0 ? n - 1 - at : at; };
    for (int c = 0; c < nz; ++c) {
      const int k = from(d[2], nz, c);
      for (int b = 0; b < ny; ++b) {
        const int j = from(d[1], ny, b);
        for (int a = 0; a < nx; ++a) {
          const int i = from(d[0], nx, a), x = i + d[0], y = j + d[1], z = k + d[2];
          const std::size_t here = lattice.index(i, j, k);
          before[here] = 0;
          if (x < 0 || y < 0 || z < 0 || x >= nx || y >= ny || z >= nz) continue;
          const std::size_t next = lattice.index(x, y, z);
          before[here] = wall[next] != 0 || before[next] != 0 ? 1 : 0;
          count[here] = static_cast<std::uint8_t>(count[here] + before[here]);
        }
      }
    }
  }
  return count;
}

/// The number of each voxel's cavity, or kOutside.
std::vector<std::int32_t> cavities_of(const std::vector<std::uint8_t>& wall, const Lattice& lattice) {
  const std::vector<std::uint8_t> enclosure = enclosure_of(wall, lattice);
  const auto solid = static_cast<double>(std::count(wall.begin(), wall.end(), std::uint8_t{1}));
  std::vector<std::int32_t> cavity(wall.size(), WallStairs::kOutside);
  std::vector<std::uint8_t> seen(wall.size(), 0);
  const std::array<std::size_t, 3> stride{1, as_size(lattice.count[0]),
                                          as_size(lattice.count[0]) * as_size(lattice.count[1])};
  std::int32_t next = 0;
  for (std::size_t start = 0; start < wall.size(); ++start) {
    if (seen[start] != 0 || wall[start] != 0 || enclosure[start] < kDeep) continue;
    std::vector<std::size_t> voxels{start};
    seen[start] = 1;
    for (std::size_t v = 0; v < voxels.size(); ++v) {
      const std::size_t from = voxels[v];
      for (const std::size_t step : stride) {
        // Those at the ends of the lattice are enclosed in half of the directions at most.
        for (const std::size_t to : {from - step, from + step}) {
          if (to >= wall.size() || seen[to] != 0 || wall[to] != 0 || enclosure[to] < kWithin) continue;
          seen[to] = 1;
          voxels.push_back(to);
        }
      }
    }
    if (static_cast<double>(voxels.size()) < kSmallCavity * solid) continue;
    for (const std::size_t v : voxels) cavity[v] = next;
    ++next;
  }
  return cavity;
}

/// Means of the normals around each triangle, of those that have its number. Not of unit length.
std::vector<Vec3> mean_normals(const WallBorder& border, const std::vector<std::int32_t>& number) {
  std::vector<Vec3> means = border.areas;
  for (int round = 0; round < kRounds; ++round) {
    std::vector<Vec3> next = means;
    for (const auto& [a, b] : border.joints) {
      if (number[a] != number[b]) continue;
      next[a] += means[b];
      next[b] += means[a];
    }
    for (std::size_t t = 0; t < next.size(); ++t) {
      const double length = glm::length(next[t]);
      means[t] = length > 0.0 ? next[t] * (glm::length(border.areas[t]) / length) : border.areas[t];
    }
  }
  return means;
}

/// Makes rims of what faces the opening and hangs together with an edge between a cavity and the outside.
/// @param own cosine to the opening from which on a triangle beside them is of a rim by its own normal, too: edges of a
/// rim that the mesh does not have are cut off. Normals of stairs say nothing: 2.
void find_rims(const WallBorder& border, const Vec3& opening, double own, std::vector<std::int32_t>& beside) {
  const std::vector<Vec3> means = mean_normals(border, beside);
  std::vector<bool> up(beside.size()), rim(beside.size());
  for (std::size_t t = 0; t < up.size(); ++t)
    up[t] = glm::dot(means[t], opening) > kFacesUp * glm::length(means[t]);
  std::vector<std::vector<std::uint32_t>> joined(beside.size());
  std::vector<std::uint32_t> front, edge;
  const auto begin = [&](std::uint32_t t) {
    if (!up[t] || rim[t]) return;
    rim[t] = true;
    front.push_back(t);
  };
  for (const auto& [a, b] : border.joints) {
    joined[a].push_back(b);
    joined[b].push_back(a);
    if (beside[a] == beside[b]) continue;
    edge.push_back(a);
    edge.push_back(b);
    begin(a);
    begin(b);
  }
  for (std::size_t f = 0; f < front.size(); ++f) {
    const std::uint32_t from = front[f];  // `front` may move
    for (const std::uint32_t t : joined[from]) begin(t);
  }
  const auto cut_off = [&](std::uint32_t t) { return glm::dot(border.normal(t), opening) > own; };
  for (const std::uint32_t t : edge)
    if (cut_off(t)) rim[t] = true;
  constexpr int kWide = 2;  // triangles
  for (int round = 0; round < kWide; ++round) {
    const std::vector<bool> before = rim;
    for (const auto& [a, b] : border.joints) {
      if (before[a] && cut_off(b)) rim[b] = true;
      if (before[b] && cut_off(a)) rim[a] = true;
    }
  }
  for (std::size_t t = 0; t < rim.size(); ++t)
    if (rim[t]) beside[t] = WallStairs::kRim;
}

/// Lets small patches be what is beside them, but for rims: voxels just within an opening may count as outside.
void join_patches(const WallBorder& border, std::vector<std::int32_t>& beside) {
  constexpr double kSmallPatch = 0.05;  // of the border's area
  DisjointSets patches(beside.size());
  for (const auto& [a, b] : border.joints)
    if (beside[a] == beside[b]) patches.unite(a, b);
  std::vector<double> areas(beside.size(), 0.0);
  double all = 0.0;
  for (std::size_t t = 0; t < beside.size(); ++t) {
    const double area = glm::length(border.areas[t]);
    areas[patches.find(static_cast<std::uint32_t>(t))] += area;
    all += area;
  }
  std::map<std::uint32_t, std::map<std::int32_t, std::size_t>>
      contacts;  // of small patches, by what is beside
  const auto touch = [&](std::uint32_t from, std::uint32_t to) {
    const std::uint32_t patch = patches.find(from);
    if (beside[from] != WallStairs::kRim && areas[patch] < kSmallPatch * all) ++contacts[patch][beside[to]];
  };
  for (const auto& [a, b] : border.joints) {
    if (beside[a] == beside[b]) continue;
    touch(a, b);
    touch(b, a);
  }
  for (std::size_t t = 0; t < beside.size(); ++t) {
    const auto found = contacts.find(patches.find(static_cast<std::uint32_t>(t)));
    if (found == contacts.end()) continue;
    std::size_t most = 0;
    for (const auto& [number, count] : found->second) {
      if (number == WallStairs::kRim || count <= most) continue;
      most = count;
      beside[t] = number;
    }
  }
}

/// A lattice along the coordinate axes over cells of any shape.
Lattice laid_over(const TetMesh& mesh, const WallBorder& border) {
  constexpr double kMostLaid = 2e6;  // voxels
  Box box;
  std::vector<double> edges;
  for (const auto& triangle : border.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      box.include(mesh.points()[triangle[i]]);
      edges.push_back(glm::distance(mesh.points()[triangle[i]], mesh.points()[triangle[(i + 1) % 3]]));
    }
  }
  const auto middle = edges.begin() + static_cast<std::ptrdiff_t>(edges.size() / 2);
  std::nth_element(edges.begin(), middle, edges.end());
  const Vec3 size = box.size();
  const double step = std::max(0.5 * *middle, std::cbrt(size.x * size.y * size.z / kMostLaid));
  Lattice lattice;
  lattice.step = Vec3{step};
  for (int a = 0; a < 3; ++a) {
    lattice.count[as_size(a)] = static_cast<int>(std::ceil(size[a] / step)) + 2;
    lattice.origin[a] = box.lower[a] - 0.5 * (lattice.count[as_size(a)] * step - size[a]);
  }
  return lattice;
}

/// What each triangle borders: the first voxel before it that is no wall says so.
std::vector<std::int32_t> what_is_beside(const TetMesh& mesh, const WallBorder& border,
                                         const Lattice& lattice, const std::vector<std::uint8_t>& wall,
                                         const std::vector<std::int32_t>& cavity) {
  constexpr int kFarthest = 4;  // half steps: voxels whose middle is wall may stick out of it
  std::vector<std::int32_t> beside;
  for (std::size_t t = 0; t < border.triangles.size(); ++t) {
    const Vec3 half = 0.5 * border.normal(t) * std::min({lattice.step[0], lattice.step[1], lattice.step[2]});
    const Vec3 middle = triangle_middle(mesh.points(), border.triangles[t]);
    std::int32_t found = WallStairs::kOutside;
    for (int n = 1; n <= kFarthest; ++n) {
      const auto voxel = lattice.at(middle + static_cast<double>(n) * half);
      if (voxel && wall[*voxel] != 0) continue;
      if (voxel) found = cavity[*voxel];
      break;
    }
    beside.push_back(found);
  }
  return beside;
}

/// @param own as find_rims().
std::optional<WallStairs> in_lattice(const TetMesh& mesh, const WallBorder& border, const Lattice& lattice,
                                     double own) {
  const std::vector<std::uint8_t> wall = wall_of(mesh, lattice);
  WallStairs stairs{.step = std::max({lattice.step[0], lattice.step[1], lattice.step[2]}),
                    .beside = what_is_beside(mesh, border, lattice, wall, cavities_of(wall, lattice)),
                    .areas = border.areas};
  if (std::all_of(stairs.beside.begin(), stairs.beside.end(),
                  [](std::int32_t number) { return number == WallStairs::kOutside; }))
    return std::nullopt;
  Vec3 opening{0.0};
  for (std::size_t t = 0; t < border.areas.size(); ++t)
    if (stairs.beside[t] != WallStairs::kOutside) opening += border.areas[t];
  if (const double length = glm::length(opening); length > 0.0)
    find_rims(border, opening / length, own, stairs.beside);
  join_patches(border, stairs.beside);
  return stairs;
}

}  // namespace

std::optional<WallStairs> find_wall_stairs(const TetMesh& mesh, const WallBorder& border) {
  Lattice lattice;
  if (!find_axes(border, lattice.axes) || !find_planes(mesh.points(), border, lattice)) return std::nullopt;
  std::optional<WallStairs> stairs = in_lattice(mesh, border, lattice, 2.0);
  if (!stairs) return std::nullopt;
  const std::vector<Vec3> means = mean_normals(border, stairs->beside);
  for (std::size_t t = 0; t < means.size(); ++t) {
    const double length = glm::length(means[t]);
    const Vec3 normal = length > 0.0 ? means[t] / length : Vec3{0.0};
    stairs->areas[t] = normal * std::max(0.0, glm::dot(normal, border.areas[t]));
  }
  return stairs;
}

std::optional<WallStairs> find_closed_cavities(const TetMesh& mesh, const WallBorder& border) {
  if (border.triangles.empty()) return std::nullopt;
  constexpr double kOwn = 0.5;  // edges of a rim that the mesh does not have are cut off at some 45 degrees
  return in_lattice(mesh, border, laid_over(mesh, border), kOwn);
}

}  // namespace palpate
