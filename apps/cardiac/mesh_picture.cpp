#include "apps/cardiac/mesh_picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "common/base/text.h"
#include "common/field/grid/mesh_quality.h"
#include "common/render/camera.h"

namespace palpate {
namespace {

/// Of a regular tetrahedron: acos(1/3) [degrees]. The smallest angle of others is less.
constexpr double kRegularAngle = 70.528779365509;

/// Cells that stay where those beyond the middle of the mesh, towards `viewer`, are taken off.
std::vector<bool> farther_half(const TetMesh& mesh, const Vec3& viewer) {
  const double middle = glm::dot(mesh.bounds().center(), viewer);
  std::vector<bool> stays(mesh.cells().size());
  for (std::size_t c = 0; c < stays.size(); ++c) {
    const auto cell = static_cast<CellIndex>(c);
    stays[c] = !mesh.zero_volume(cell) && glm::dot(mesh.position(cell, Vec4{0.25}), viewer) <= middle;
  }
  return stays;
}

}  // namespace

SceneView mesh_view(const TetMesh& mesh, const std::string& title, double aspect) {
  SceneView view;
  view.bounds = mesh.bounds();
  view.camera = make_camera(view.bounds, {}, aspect);
  const std::vector<bool> stays = farther_half(mesh, view.camera.axes[2]);

  IsosurfaceMesh faces;
  std::vector<float> angles;
  for (std::size_t c = 0; c < stays.size(); ++c) {
    if (!stays[c]) continue;
    const TetMesh::Tet& tet = mesh.cells()[c];
    std::array<Vec3, 4> corners{};
    for (std::size_t i = 0; i < 4; ++i) corners[i] = mesh.points()[tet[i]];
    const std::array<double, 6> all = dihedral_angles(corners);
    const auto least = static_cast<float>(*std::min_element(all.begin(), all.end()));
    for (std::size_t f = 0; f < 4; ++f) {
      const CellIndex behind = mesh.neighbors()[c][f];
      if (behind != kNoCell && stays[static_cast<std::size_t>(behind)]) continue;
      // The face across from corner f, seen from outside.
      std::array<Vec3, 3> face{corners[(f + 1) % 4], corners[(f + 2) % 4], corners[(f + 3) % 4]};
      Vec3 outward = glm::cross(face[1] - face[0], face[2] - face[0]);
      if (glm::dot(outward, corners[f] - face[0]) > 0.0) {
        std::swap(face[1], face[2]);
        outward = -outward;
      }
      const auto first = static_cast<std::uint32_t>(faces.points.size());
      faces.triangles.push_back({first, first + 1, first + 2});
      for (const Vec3& x : face) {
        faces.points.push_back(x);
        faces.normals.emplace_back(glm::normalize(outward));
        angles.push_back(least);
      }
    }
  }

  LineArray of_cells{.name = "smallest angle between faces", .unit = "degrees", .values = {}};
  of_cells.range = ValueRange{0.0, kRegularAngle};
  view.style.color_by = ColorBy::kArray;
  view.style.array = std::make_shared<const LineArray>(std::move(of_cells));
  view.style.range = ValueRange{0.0, kRegularAngle};
  view.surfaces = {{.mesh = std::make_shared<const IsosurfaceMesh>(std::move(faces)),
                    .values = std::make_shared<const std::vector<float>>(std::move(angles))}};
  view.title = title;
  view.subtitle = counted(mesh.cells().size(), "tetrahedron") + ", cut open";
  return view;
}

}  // namespace palpate
