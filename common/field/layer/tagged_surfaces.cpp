#include "common/field/layer/tagged_surfaces.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "common/base/text.h"
#include "common/field/layer/septum_side.h"
#include "common/field/layer/surface_areas.h"

namespace palpate {
namespace {

/// The numbers at the grid's points; 0 where there is another one.
std::vector<std::uint8_t> tags_of_points(const FieldGrid& grid, const DataArray& array) {
  std::vector<std::uint8_t> tags(grid.point_count(), 0);
  for (std::size_t p = 0; p < array.tuples; ++p) {
    const double tag = array.at(p);
    const std::size_t point = grid.point_of_input.empty() ? p : grid.point_of_input[p];
    if (point >= tags.size()) continue;  // no cell uses it
    for (int role = 1; role < kBorderRoleCount; ++role)
      if (tag == role) tags[point] = static_cast<std::uint8_t>(role);
  }
  return tags;
}

/// Which of both surfaces a point with each tag lies on.
std::vector<WallSurface> tagged_points(const std::vector<std::uint8_t>& tags) {
  std::vector<WallSurface> surfaces;
  surfaces.reserve(tags.size());
  for (const std::uint8_t tag : tags) {
    const BorderRole role = role_of_tag(tag);
    surfaces.push_back(role == BorderRole::kInner || role == BorderRole::kRight    ? WallSurface::kInner
                       : role == BorderRole::kOuter || role == BorderRole::kSeptum ? WallSurface::kOuter
                                                                                   : WallSurface::kNone);
  }
  return surfaces;
}

/// Roles of triangles by the tags of their points.
std::vector<BorderRole> tagged_roles(const WallBorder& border, const std::vector<std::uint8_t>& tags) {
  std::vector<BorderRole> roles(border.triangles.size(), BorderRole::kLeft);
  const auto count = [&](std::size_t t, BorderRole role) {
    return std::count_if(border.triangles[t].begin(), border.triangles[t].end(),
                         [&](std::uint32_t p) { return role_of_tag(tags[p]) == role; });
  };
  Vec3 opening{0.0};
  double outer = 0.0;
  for (std::size_t t = 0; t < roles.size(); ++t) {
    for (const BorderRole role :
         {BorderRole::kInner, BorderRole::kOuter, BorderRole::kRight, BorderRole::kSeptum})
      if (count(t, role) == 3) roles[t] = role;
    // Between both sides of the right cavity, whose points lie on the inner surface where they meet.
    if (count(t, BorderRole::kSeptum) > 0 &&
        count(t, BorderRole::kSeptum) + count(t, BorderRole::kRight) == 3)
      roles[t] = BorderRole::kSeptum;
    if (roles[t] != BorderRole::kOuter) continue;
    opening -= border.areas[t];
    outer += glm::length(border.areas[t]);
  }
  constexpr double kOpens = 0.05;  // mean normal of a surface that does not go all round
  constexpr double kUp = 0.3;      // normal times axis of what does not lie along the wall
  if (!(glm::length(opening) > kOpens * outer)) return roles;
  // Where an inner surface meets an outer one, as at the rim of a septum, triangles have points of both, too.
  for (std::size_t t = 0; t < roles.size(); ++t)
    if (roles[t] == BorderRole::kLeft && glm::dot(border.normal(t), glm::normalize(opening)) > kUp)
      roles[t] = BorderRole::kBase;
  return roles;
}

/// Makes the septum's side of the right endocardium's triangles, where none is named: it counts as outer.
/// @return whether there is one.
bool find_septum(const FieldGrid& grid, const WallBorder& border, WallSurfaces& surfaces) {
  RightPart part{.triangles = {}, .area = 0.0, .one_of_several = false};
  std::vector<std::uint32_t> right;
  for (std::size_t t = 0; t < surfaces.roles.size(); ++t) {
    if (surfaces.roles[t] != BorderRole::kRight) continue;
    right.push_back(static_cast<std::uint32_t>(t));
    part.area += glm::length(border.areas[t]);
  }
  part.triangles = right;
  const SeptumSide side = find_septum_side(*grid.tets, border, surfaces.roles, {&part, 1});
  if (!(side.area > 0.0)) return false;
  for (const std::uint32_t t : right) {
    if (!side.septum[t]) continue;
    surfaces.roles[t] = BorderRole::kSeptum;
    for (const std::uint32_t p : border.triangles[t]) surfaces.of_point[p] = WallSurface::kOuter;
  }
  // Where the septum meets the free wall, and the left cavity at the rim, points are inner ones.
  for (std::size_t t = 0; t < surfaces.roles.size(); ++t)
    if (surfaces.roles[t] == BorderRole::kRight || surfaces.roles[t] == BorderRole::kInner)
      for (const std::uint32_t p : border.triangles[t]) surfaces.of_point[p] = WallSurface::kInner;
  return true;
}

/// How far across the points of both surfaces are.
void doubt_sides(const FieldGrid& grid, WallSurfaces& surfaces) {
  Box inner, outer;
  for (std::size_t p = 0; p < surfaces.of_point.size(); ++p) {
    if (surfaces.of_point[p] == WallSurface::kInner) inner.include(grid.tets->points()[p]);
    if (surfaces.of_point[p] == WallSurface::kOuter) outer.include(grid.tets->points()[p]);
  }
  const double scale = grid.frame.length_scale();
  if (inner.diagonal() > outer.diagonal())
    surfaces.doubts.push_back("the inner surface that the file names is " +
                              short_number(scale * inner.diagonal()) + " across and the outer one " +
                              short_number(scale * outer.diagonal()) +
                              ": are they named the other way round?");
}

}  // namespace

WallSurfaces tagged_surfaces(const FieldGrid& grid, const WallBorder& border, const DataArray& array) {
  constexpr double kLeastConfidence = 0.8;  // a coarse mesh whose rims are on none has 0.9
  const std::vector<std::uint8_t> tags = tags_of_points(grid, array);
  WallSurfaces surfaces;
  surfaces.triangles = border.triangles;
  surfaces.of_point = tagged_points(tags);
  surfaces.roles = tagged_roles(border, tags);
  const auto has = [&surfaces](BorderRole role) {
    return std::find(surfaces.roles.begin(), surfaces.roles.end(), role) != surfaces.roles.end();
  };
  bool found = false;
  if (has(BorderRole::kRight) && has(BorderRole::kInner) && !has(BorderRole::kSeptum)) {
    found = find_septum(grid, border, surfaces);
    if (!found) surfaces.doubts.emplace_back("no wall between the cavities was found: none has a septum");
  }
  measure_surfaces(grid, border, surfaces);
  surfaces.note =
      std::string("inner and outer surface from the array '") + kSurfaceArray + "': " + areas_text(surfaces);
  if (found) surfaces.note += "; it names no septum: that is found by the way through the wall";
  std::size_t unknown = 0;
  for (std::size_t p = 0; p < array.tuples; ++p) {
    const double tag = array.at(p);
    unknown += tag == std::floor(tag) && tag >= 0.0 && tag < kBorderRoleCount ? 0 : 1;
  }
  if (unknown > 0)
    surfaces.note += "; " + counted(unknown, "point") + " with other numbers than 0 to 5: on none";
  doubt_sides(grid, surfaces);
  if (surfaces.confidence < kLeastConfidence)
    surfaces.doubts.push_back("what the file names leaves out " +
                              short_number(std::round(100.0 * (1.0 - surfaces.confidence))) +
                              " % of the border");
  return surfaces;
}

}  // namespace palpate
