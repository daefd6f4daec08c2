#include "common/field/layer/wall_coordinates.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <numbers>
#include <queue>
#include <utility>

#include "common/base/error.h"
#include "common/base/index.h"
#include "common/base/text.h"
#include "common/field/layer/laplace.h"
#include "common/field/layer/way_lengths.h"

namespace palpate {
namespace {

constexpr double kNotGiven = std::numeric_limits<double>::quiet_NaN();
/// From the axis, in parts of the mesh's diagonal: nearer there is no way round.
constexpr double kOnAxis = 1e-9;

/// The mean of a surface's points, weighted by the area around; nothing where it has none. Frame L.
std::optional<Vec3> middle_of(const TetMesh& mesh, const WallSurfaces& surfaces, BorderRole role) {
  Vec3 sum{0.0};
  double all = 0.0;
  for (std::size_t t = 0; t < surfaces.roles.size(); ++t) {
    if (surfaces.roles[t] != role) continue;
    const auto [a, b, c] = surfaces.triangles[t];
    const Vec3 xa = mesh.points()[a], xb = mesh.points()[b], xc = mesh.points()[c];
    const double area = glm::length(glm::cross(xb - xa, xc - xa));
    sum += area * (xa + xb + xc) / 3.0;
    all += area;
  }
  if (!(all > 0.0)) return std::nullopt;
  return sum / all;
}

/// The mean of the edges that bound the left endocardium; nothing where it is closed. Frame L.
std::optional<Vec3> middle_of_rim(const TetMesh& mesh, const WallSurfaces& surfaces) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> count;
  for (std::size_t t = 0; t < surfaces.roles.size(); ++t) {
    if (surfaces.roles[t] != BorderRole::kInner) continue;
    const auto& triangle = surfaces.triangles[t];
    for (std::size_t i = 0; i < 3; ++i) ++count[std::minmax(triangle[i], triangle[(i + 1) % 3])];
  }
  Vec3 sum{0.0};
  double all = 0.0;
  for (const auto& [edge, times] : count) {
    if (times != 1) continue;
    const Vec3 a = mesh.points()[edge.first], b = mesh.points()[edge.second];
    sum += glm::distance(a, b) * 0.5 * (a + b);
    all += glm::distance(a, b);
  }
  if (!(all > 0.0)) return std::nullopt;
  return sum / all;
}

std::uint32_t lowest_point(const TetMesh& mesh, const WallSurfaces& surfaces, BorderRole role,
                           const Vec3& up) {
  std::uint32_t lowest = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t t = 0; t < surfaces.roles.size(); ++t) {
    if (surfaces.roles[t] != role) continue;
    for (const std::uint32_t p : surfaces.triangles[t]) {
      const double height = glm::dot(mesh.points()[p], up);
      if (!(height < least)) continue;
      least = height;
      lowest = p;
    }
  }
  return lowest;
}

/// The points along the shortest way over edges, both ends included; the ends alone where there is none.
std::vector<std::uint32_t> edges_between(const TetMesh& mesh, std::uint32_t from, std::uint32_t to) {
  const CellsOfPoints around = cells_of_points(mesh);
  std::vector<double> length(mesh.points().size(), std::numeric_limits<double>::infinity());
  std::vector<std::uint32_t> before(length.size(), from);
  using Entry = std::pair<double, std::uint32_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> front;
  length[from] = 0.0;
  front.emplace(0.0, from);
  while (!front.empty() && front.top().second != to) {
    const auto [so_far, p] = front.top();
    front.pop();
    if (so_far > length[p]) continue;
    for (std::size_t n = around.begin[p]; n < around.begin[p + 1]; ++n) {
      for (const std::uint32_t q : mesh.cells()[around.cells[n]]) {
        const double there = so_far + glm::distance(mesh.points()[p], mesh.points()[q]);
        if (!(there < length[q])) continue;
        length[q] = there;
        before[q] = p;
        front.emplace(there, q);
      }
    }
  }
  std::vector<std::uint32_t> way{to};
  while (way.back() != from) way.push_back(before[way.back()]);
  std::reverse(way.begin(), way.end());
  return way;
}

std::string place_text(const Vec3& x) {
  return short_number(x.x) + ", " + short_number(x.y) + ", " + short_number(x.z);
}

/// What the angle is measured from, across the axis; and what that is. Frame L.
std::pair<Vec3, std::string> zero_direction(const TetMesh& mesh, const WallSurfaces& surfaces,
                                            const Vec3& middle, const Vec3& axis) {
  for (const BorderRole role : {BorderRole::kSeptum, BorderRole::kRight}) {
    const auto there = middle_of(mesh, surfaces, role);
    if (!there) continue;
    const Vec3 way = *there - middle, across = way - glm::dot(way, axis) * axis;
    if (glm::length(across) > kOnAxis * mesh.bounds().diagonal())
      return {glm::normalize(across),
              role == BorderRole::kSeptum ? "the middle of the septum" : "the right ventricle"};
  }
  int chosen = 0;
  while (chosen < 2 && std::abs(axis[chosen]) > std::numbers::sqrt2 / 2.0) ++chosen;
  Vec3 way{0.0};
  way[chosen] = 1.0;
  return {glm::normalize(way - axis[chosen] * axis), std::string("the coordinate axis ") + "xyz"[chosen]};
}

}  // namespace

WallAxis find_wall_axis(const FieldGrid& grid, const WallSurfaces& surfaces, const std::string& file,
                        int threads) {
  const TetMesh& mesh = *grid.tets;
  const auto refuse = [&file](const std::string& found) {
    throw input_error({file, "", found, "a wall that is open at its base",
                       std::string("a point array '") + kSurfaceArray +
                           "' names inner (1) and outer surface (2); what is neither is the base"});
  };
  std::vector<double> given(mesh.points().size(), kNotGiven);
  give_on(surfaces, BorderRole::kBase, 1.0, given);
  if (!surfaces.has(BorderRole::kBase)) refuse("has no base");
  const auto middle = middle_of(mesh, surfaces, BorderRole::kInner), rim = middle_of_rim(mesh, surfaces);
  if (!middle || !rim || !(glm::distance(*middle, *rim) > kOnAxis * mesh.bounds().diagonal()))
    refuse("has an inner surface that does not open to one side");

  WallAxis axis;
  axis.direction = glm::normalize(*rim - *middle);
  axis.middle = grid.frame.data_from_local(*rim);
  axis.apex = edges_between(mesh, lowest_point(mesh, surfaces, BorderRole::kInner, axis.direction),
                            lowest_point(mesh, surfaces, BorderRole::kOuter, axis.direction));
  for (const std::uint32_t p : axis.apex) given[p] = 0.0;
  axis.potential = solve_laplace(mesh, given, file, threads).values;
  return axis;
}

WallCoordinates make_wall_coordinates(const FieldGrid& grid, const WallSurfaces& surfaces,
                                      const std::string& file, int threads) {
  constexpr double kPi = std::numbers::pi;
  const TetMesh& mesh = *grid.tets;
  WallCoordinates made;
  made.axis = find_wall_axis(grid, surfaces, file, threads);
  made.transmural = solve_laplace(mesh, depths_on(surfaces), file, threads).values;

  const std::vector<double> up = way_lengths(mesh, made.axis.potential, WayAlong::kFalling);
  const std::vector<double> down = way_lengths(mesh, made.axis.potential, WayAlong::kRising);
  for (std::size_t p = 0; p < up.size(); ++p) made.apicobasal.push_back(up[p] / (up[p] + down[p]));

  const Vec3 middle = grid.frame.local_from_data(made.axis.middle), axis = made.axis.direction;
  const auto [zero, zero_name] = zero_direction(mesh, surfaces, middle, axis);
  const Vec3 quarter = glm::cross(axis, zero);
  std::size_t on_axis = 0;
  for (const Vec3& x : mesh.points()) {
    const double along = glm::dot(x - middle, zero), aside = glm::dot(x - middle, quarter);
    const bool defined = std::hypot(along, aside) > kOnAxis * mesh.bounds().diagonal();
    on_axis += defined ? 0 : 1;
    double angle = defined ? std::atan2(aside, along) : kNotGiven;
    if (angle == -kPi) angle = kPi;
    made.rotational.push_back(angle);
  }

  if (surfaces.has(BorderRole::kRight)) {
    std::vector<double> given(mesh.points().size(), kNotGiven);
    for (const BorderRole left : {BorderRole::kSeptum, BorderRole::kInner})
      give_on(surfaces, left, -1.0, given);
    give_on(surfaces, BorderRole::kRight, 1.0, given);
    made.ventricle = solve_laplace(mesh, given, file, threads).values;
    for (double& side : made.ventricle)
      if (!std::isnan(side)) side = side > 0.0 ? 1.0 : -1.0;
  }

  made.notes.push_back("long axis from apex to base: " + place_text(axis) + ", through " +
                       place_text(made.axis.middle));
  made.notes.push_back("apex: " + counted(made.axis.apex.size(), "point") + " through the wall, from " +
                       place_text(grid.frame.data_from_local(mesh.points()[made.axis.apex.front()])) +
                       " to " + place_text(grid.frame.data_from_local(mesh.points()[made.axis.apex.back()])));
  made.notes.push_back("rotational 0: " + zero_name +
                       "; it jumps from pi to -pi on the other side, where cells hold both");
  if (on_axis > 0)
    made.notes.push_back("rotational is not defined at " + counted(on_axis, "point") + " on the axis");
  if (surfaces.confidence < 1.0)
    made.notes.push_back("parts of the border without a role: " +
                         short_number(std::round(1000.0 * (1.0 - surfaces.confidence)) / 10.0) + " %");
  return made;
}

}  // namespace palpate
