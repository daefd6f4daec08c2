#include "apps/cardiac/wall_view.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "apps/cardiac/default_appearance.h"
#include "common/base/index.h"
#include "common/field/grid/tet_mesh.h"
#include "common/field/layer/wall_border.h"
#include "common/scene/wall/open_wall.h"

namespace palpate {
namespace {

constexpr double kVeil = 0.25;   // opacity of a wall through which its layers are to be seen
constexpr double kFound = 0.45;  // and of what is to be looked at itself

/// Triangles of some roles as a mesh with smooth normals.
IsosurfaceMesh mesh_of(const WallParts& parts, const std::vector<BorderRole>& roles) {
  constexpr std::uint32_t kUnused = std::numeric_limits<std::uint32_t>::max();
  IsosurfaceMesh mesh;
  std::vector<std::uint32_t> place(parts.points.size(), kUnused);
  std::vector<Vec3> normals;
  for (std::size_t t = 0; t < parts.triangles.size(); ++t) {
    if (std::ranges::find(roles, parts.roles[t]) == roles.end()) continue;
    std::array<std::uint32_t, 3> triangle{};
    for (std::size_t i = 0; i < 3; ++i) {
      std::uint32_t& at = place[parts.triangles[t][i]];
      if (at == kUnused) {
        at = static_cast<std::uint32_t>(mesh.points.size());
        mesh.points.push_back(parts.points[parts.triangles[t][i]]);
        normals.emplace_back(0.0);
      }
      triangle[i] = at;
    }
    const Vec3 a = mesh.points[triangle[0]];
    const Vec3 area = glm::cross(mesh.points[triangle[1]] - a, mesh.points[triangle[2]] - a);
    for (const std::uint32_t p : triangle) normals[p] += area;
    mesh.triangles.push_back(triangle);
  }
  for (const Vec3& n : normals) {
    const double length = glm::length(n);
    mesh.normals.emplace_back(length > 0.0 ? n / length : Vec3(0.0));
  }
  return mesh;
}

/// Inner and outer surface are where the depth is least and greatest.
std::shared_ptr<const WallParts> parts_by_depth(const ScalarField& depth) {
  const TetMesh& mesh = *depth.tet_mesh();
  const std::vector<double> depths = point_values(depth);
  const double span = depth.highest() - depth.lowest();
  constexpr double kOnSurface = 1e-6;  // of the span: depths of a file may have seven digits
  const WallBorder border = border_of(mesh);
  auto parts = std::make_shared<WallParts>();
  for (const Vec3& x : mesh.points()) parts->points.push_back(depth.frame().data_from_local(x));
  parts->triangles = border.triangles;
  for (const auto& triangle : border.triangles) {
    const auto all = [&](double value) {
      return std::ranges::all_of(
          triangle, [&](std::uint32_t p) { return std::abs(depths[p] - value) <= kOnSurface * span; });
    };
    parts->roles.push_back(all(depth.lowest())    ? BorderRole::kInner
                           : all(depth.highest()) ? BorderRole::kOuter
                                                  : BorderRole::kBase);
  }
  return parts;
}

/// The polygon in which a plane meets a tetrahedron, by the distances of its corners; three or four corners, or none.
std::size_t section_of(const std::array<Vec3, 4>& x, const std::array<double, 4>& beyond,
                       std::array<Vec3, 4>& polygon) {
  std::array<std::size_t, 4> above{}, below{};
  std::size_t up = 0, down = 0;
  for (std::size_t i = 0; i < 4; ++i) (beyond[i] > 0.0 ? above[up++] : below[down++]) = i;
  if (up == 0 || down == 0) return 0;
  const auto crossing = [&](std::size_t a, std::size_t b) {
    return glm::mix(x[a], x[b], beyond[a] / (beyond[a] - beyond[b]));
  };
  if (up == 2) {
    polygon = {crossing(above[0], below[0]), crossing(above[0], below[1]), crossing(above[1], below[1]),
               crossing(above[1], below[0])};
    return 4;
  }
  const std::size_t tip = up == 1 ? above[0] : below[0];
  for (std::size_t i = 0; i < 3; ++i) polygon[i] = crossing(tip, up == 1 ? below[i] : above[i]);
  return 3;
}

}  // namespace

Rgb color_of(BorderRole role) noexcept {
  switch (role) {
    case BorderRole::kInner:
      return {0.84F, 0.25F, 0.22F};
    case BorderRole::kRight:
      return {0.22F, 0.45F, 0.85F};
    case BorderRole::kSeptum:
      return {0.62F, 0.35F, 0.80F};
    case BorderRole::kOuter:
      return {0.88F, 0.74F, 0.42F};
    case BorderRole::kBase:
      return {0.35F, 0.70F, 0.45F};
    default:
      return {0.95F, 0.35F, 0.85F};
  }
}

std::string WallPictures::shown(const Input& input, const HeartOptions& options) {
  if (options.walls != "auto") return options.walls;
  if (!input.spec().paint.empty()) return "found";
  const auto own = [](const ArrayInfo& array) {
    return array.association == Association::kPoint && array.components == 1 &&
           (array.name == kLayerArray || array.name == kSurfaceArray);
  };
  return std::ranges::any_of(input.arrays(), own) ? "none" : "found";
}

void WallPictures::find(Input& input, const Document& options, Progress* progress) {
  if (found_) return;
  const OpenWall wall = open_wall(input, {}, options.common.threads, progress);
  auto parts = std::make_shared<WallParts>();
  for (const Vec3& x : wall.grid->tets->points())
    parts->points.push_back(wall.grid->frame.data_from_local(x));
  parts->triangles = wall.surfaces.triangles;
  parts->roles = wall.surfaces.roles;
  parts->notes = wall.notes;
  found_ = std::move(parts);
}

const std::vector<SurfaceView>& WallPictures::draw(Input& input, const LayeredHeart& heart,
                                                   const Document& options, Progress* progress) {
  const std::string words = shown(input, options.heart);
  const std::string key = words + " " + options.heart.cut;
  if (key == key_) return views_;
  views_.clear();
  const auto cut = parse_cut(options.heart.cut);
  const auto add = [&](const WallParts& parts, const std::vector<BorderRole>& roles, BorderRole color,
                       double opacity) {
    IsosurfaceMesh mesh = mesh_of(parts, roles);
    if (cut) cut_surface(*cut, mesh);
    if (mesh.triangles.empty()) return;
    views_.push_back({.mesh = std::make_shared<const IsosurfaceMesh>(std::move(mesh)),
                      .color = color_of(color),
                      .opacity = opacity});
  };
  if (words == "found") {
    find(input, options, progress);
    for (int r = 0; r < kBorderRoleCount; ++r) {
      const auto role = static_cast<BorderRole>(r);
      add(*found_, {role}, role, kFound);
    }
  } else if (words != "none") {
    if (!by_depth_) by_depth_ = parts_by_depth(*heart.heart().layer);
    if (words != "outer") add(*by_depth_, {BorderRole::kInner}, BorderRole::kInner, kVeil);
    if (words != "inner") add(*by_depth_, {BorderRole::kOuter}, BorderRole::kOuter, kVeil);
  }
  key_ = key;
  return views_;
}

SurfaceView make_cut_face(const LayeredHeart& heart, const CutPlane& plane, const AngleProbe& probe,
                          double contours, int threads) {
  const ScalarField& depth = *heart.heart().layer;
  const TetMesh& mesh = *depth.tet_mesh();
  std::vector<Vec3> points;
  std::vector<double> beyond;
  points.reserve(mesh.points().size());
  for (const Vec3& x : mesh.points()) {
    points.push_back(depth.frame().data_from_local(x));
    beyond.push_back(plane.beyond(points.back()));
  }
  IsosurfaceMesh face;
  for (std::size_t c = 0; c < mesh.cells().size(); ++c) {
    if (mesh.zero_volume(static_cast<CellIndex>(c))) continue;
    const TetMesh::Tet& tet = mesh.cells()[c];
    std::array<Vec3, 4> polygon{};
    const std::size_t corners =
        section_of({points[tet[0]], points[tet[1]], points[tet[2]], points[tet[3]]},
                   {beyond[tet[0]], beyond[tet[1]], beyond[tet[2]], beyond[tet[3]]}, polygon);
    const auto first = static_cast<std::uint32_t>(face.points.size());
    for (std::size_t i = 0; i < corners; ++i) face.points.push_back(polygon[i]);
    for (std::uint32_t i = 2; i < corners; ++i) face.triangles.push_back({first, first + i - 1, first + i});
  }
  face.normals.assign(face.points.size(), Vec3f(plane.normal));
  const std::vector<double> values = values_at(probe, face.points, threads);
  SurfaceView view{.mesh = {}, .color = color_of(BorderRole::kInner), .contours = contours};
  view.values = std::make_shared<const std::vector<float>>(values.begin(), values.end());
  view.mesh = std::make_shared<const IsosurfaceMesh>(std::move(face));
  return view;
}

void add_wall(Input& input, const LayeredHeart& heart, const Document& options, const LayerColors& colors,
              WallPictures& pictures, std::vector<SurfaceView>& surfaces, Progress* progress) {
  const auto cut = parse_cut(options.heart.cut);
  if (cut && options.heart.cut_face)
    surfaces.push_back(
        make_cut_face(heart, *cut, *colors.probe, options.heart.contours, options.common.threads));
  const std::vector<SurfaceView>& walls = pictures.draw(input, heart, options, progress);
  surfaces.insert(surfaces.end(), walls.begin(), walls.end());
}

}  // namespace palpate
