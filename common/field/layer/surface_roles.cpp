// What is asked of surfaces that were found: wall_surfaces.h.
#include <array>
#include <limits>

#include "common/field/layer/wall_surfaces.h"

namespace palpate {
namespace {

/// In the order of their numbers in files.
constexpr std::array<BorderRole, kBorderRoleCount> kTagged{BorderRole::kLeft,   BorderRole::kInner,
                                                           BorderRole::kOuter,  BorderRole::kRight,
                                                           BorderRole::kSeptum, BorderRole::kBase};

}  // namespace

int tag_of(BorderRole role) noexcept {
  for (int tag = 0; tag < kBorderRoleCount; ++tag)
    if (role_of_tag(tag) == role) return tag;
  return 0;
}

BorderRole role_of_tag(int tag) noexcept {
  return tag > 0 && tag < kBorderRoleCount ? kTagged[static_cast<std::size_t>(tag)] : BorderRole::kLeft;
}

const char* name_of(BorderRole role) noexcept {
  switch (role) {
    case BorderRole::kOuter:
      return "epicardium";
    case BorderRole::kInner:
      return "left endocardium";
    case BorderRole::kRight:
      return "right endocardium";
    case BorderRole::kSeptum:
      return "septum on the right";
    case BorderRole::kBase:
      return "base";
    default:
      return "none";
  }
}

std::vector<double> depths_on(const WallSurfaces& surfaces) {
  std::vector<double> depths(surfaces.of_point.size(), std::numeric_limits<double>::quiet_NaN());
  for (std::size_t p = 0; p < depths.size(); ++p) {
    if (surfaces.of_point[p] == WallSurface::kInner) depths[p] = 0.0;
    if (surfaces.of_point[p] == WallSurface::kOuter) depths[p] = 1.0;
  }
  return depths;
}

void give_on(const WallSurfaces& surfaces, BorderRole role, double value, std::vector<double>& given) {
  for (std::size_t t = 0; t < surfaces.roles.size(); ++t) {
    if (surfaces.roles[t] != role) continue;
    for (const std::uint32_t p : surfaces.triangles[t]) given[p] = value;
  }
}

std::vector<std::string> notes_of(const WallSurfaces& surfaces) {
  std::vector<std::string> notes{surfaces.note};
  for (const std::string& doubt : surfaces.doubts)
    notes.push_back("WARNING: surfaces of the wall are in doubt: " + doubt + "; a point array '" +
                    kSurfaceArray + "' names them (1 inner, 2 outer)");
  return notes;
}

}  // namespace palpate
