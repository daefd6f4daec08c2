#include "common/field/layer/tagged_surfaces.h"

#include <algorithm>
#include <cstddef>

namespace palpate {

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

}  // namespace palpate
