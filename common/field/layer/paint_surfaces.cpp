#include "common/field/layer/paint_surfaces.h"

#include <array>
#include <limits>
#include <string_view>
#include <utility>

#include "common/base/error.h"
#include "common/base/text.h"
#include "common/field/layer/surface_areas.h"
#include "common/field/layer/wall_border.h"

namespace palpate {
namespace {

constexpr std::array<std::pair<std::string_view, BorderRole>, 5> kPaints{{{"inner", BorderRole::kInner},
                                                                          {"outer", BorderRole::kOuter},
                                                                          {"right", BorderRole::kRight},
                                                                          {"septum", BorderRole::kSeptum},
                                                                          {"base", BorderRole::kBase}}};

/// @return how many triangles got another role.
std::size_t paint_border(const FieldGrid& grid, const WallBorder& border, const SurfacePaint& paint,
                         std::vector<BorderRole>& roles) {
  const std::span<const Vec3> points = grid.tets->points();
  const Vec3 center = grid.frame.local_from_data(paint.center);
  const double radius = paint.radius / grid.frame.length_scale();
  double least = std::numeric_limits<double>::infinity();
  std::size_t nearest = border.triangles.size();
  const auto away = [&](std::size_t t) {
    return glm::distance(triangle_middle(points, border.triangles[t]), center);
  };
  for (std::size_t t = 0; t < border.triangles.size(); ++t) {
    if (!(away(t) < least)) continue;
    least = away(t);
    nearest = t;
  }
  if (nearest == border.triangles.size()) return 0;
  std::size_t painted = 0;
  for (std::size_t t = 0; t < border.triangles.size(); ++t) {
    if (t != nearest && (!(away(t) <= radius) || !(glm::dot(border.areas[t], border.areas[nearest]) > 0.0)))
      continue;
    painted += roles[t] == paint.role ? 0 : 1;
    roles[t] = paint.role;
  }
  return painted;
}

}  // namespace

std::vector<SurfacePaint> parse_paint(const std::vector<std::string>& texts) {
  std::vector<SurfacePaint> paints;
  for (const std::string& text : texts) {
    const std::string grammar = "--paint-surface " + text + ": takes inner|outer|right|septum|base:x,y,z,r";
    const std::size_t colon = text.find(':');
    SurfacePaint paint;
    bool known = false;
    for (const auto& [name, role] : kPaints) {
      if (text.substr(0, colon) != name) continue;
      paint.role = role;
      known = true;
    }
    if (!known || colon == std::string::npos) throw usage_error(grammar);
    const std::vector<double> v = parse_numbers(std::string_view(text).substr(colon + 1), 4, grammar);
    if (!(v[3] > 0.0)) throw usage_error(grammar + ", r above 0");
    paint.center = {v[0], v[1], v[2]};
    paint.radius = v[3];
    paints.push_back(paint);
  }
  return paints;
}

std::string paint_text(const SurfacePaint& paint) {
  std::string text;
  for (const auto& [name, role] : kPaints)
    if (role == paint.role) text = name;
  return text + ":" + exact_number(paint.center.x) + "," + exact_number(paint.center.y) + "," +
         exact_number(paint.center.z) + "," + exact_number(paint.radius);
}

WallSurfaces find_painted_surfaces(const FieldGrid& grid, const DataSet& mesh, const std::string& file,
                                   std::span<const SurfacePaint> paint) {
  if (paint.empty() || !grid.tets) return find_wall_surfaces(grid, mesh, file);
  const WallBorder border = border_of(*grid.tets);
  WallSurfaces surfaces;
  std::string why;
  try {
    surfaces = find_wall_surfaces(grid, mesh, file);
  } catch (const Error& error) {
    if (error.code() == ExitCode::kInterrupted) throw;
    why = error.what();
    surfaces.triangles = border.triangles;
    surfaces.roles.assign(border.triangles.size(), BorderRole::kLeft);
    surfaces.note = "surfaces as they are painted; by shape none were found";
  }
  std::size_t painted = 0;
  for (const SurfacePaint& each : paint) painted += paint_border(grid, border, each, surfaces.roles);
  surfaces.areas = {};
  surfaces.pieces = {};
  measure_surfaces(grid, border, surfaces);
  mark_points(grid, surfaces);
  if (!surfaces.has(BorderRole::kOuter) ||
      !(surfaces.has(BorderRole::kInner) || surfaces.has(BorderRole::kRight)))
    throw input_error({file, "", why.empty() ? "has only one side where it is painted so" : why,
                       "an inner and an outer surface", "--paint-surface names them, too"});
  surfaces.note += "; painted at " + counted(paint.size(), "place") + ": " + counted(painted, "triangle") +
                   " of another surface than was found, now " + areas_text(surfaces);
  return surfaces;
}

}  // namespace palpate
