#include "common/field/grid/mesh_quality.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>

#include "common/base/index.h"

namespace palpate {
namespace {

std::size_t step_of(double angle) { return std::min<std::size_t>(17, floor_size(angle / 10.0)); }

void count_components(const TetMesh& mesh, MeshQuality& quality) {
  std::vector<std::uint8_t> seen(mesh.cells().size(), 0);
  std::vector<CellIndex> front;
  for (std::size_t start = 0; start < seen.size(); ++start) {
    if (seen[start] != 0) continue;
    std::size_t size = 0;
    seen[start] = 1;
    front.push_back(static_cast<CellIndex>(start));
    while (!front.empty()) {
      const auto c = as_size(front.back());
      front.pop_back();
      ++size;
      for (const CellIndex next : mesh.neighbors()[c]) {
        if (next == kNoCell || seen[as_size(next)] != 0) continue;
        seen[as_size(next)] = 1;
        front.push_back(next);
      }
    }
    ++quality.components;
    quality.largest_component = std::max(quality.largest_component, size);
  }
}

void count_border(const TetMesh& mesh, MeshQuality& quality) {
  std::vector<std::uint64_t> edges;
  for (std::size_t c = 0; c < mesh.cells().size(); ++c) {
    for (std::size_t f = 0; f < 4; ++f) {
      if (mesh.neighbors()[c][f] != kNoCell) continue;
      ++quality.border_faces;
      for (std::size_t i = 0; i < 3; ++i) {
        const std::uint64_t a = mesh.cells()[c][kTetFaces[f][i]],
                            b = mesh.cells()[c][kTetFaces[f][(i + 1) % 3]];
        edges.push_back(std::min(a, b) << 32U | std::max(a, b));
      }
    }
  }
  std::sort(edges.begin(), edges.end());
  for (std::size_t e = 0; e < edges.size();) {
    std::size_t next = e;
    while (next < edges.size() && edges[next] == edges[e]) ++next;
    quality.open_edges += (next - e) % 2;
    quality.manifold_faults += next - e > 2 ? 1 : 0;
    e = next;
  }
}

}  // namespace

std::size_t folded_faces(const TetMesh& mesh) {
  std::size_t folded = mesh.overlapping_face_count();  // which have no neighbours there
  for (std::size_t c = 0; c < mesh.cells().size(); ++c) {
    if (mesh.zero_volume(static_cast<CellIndex>(c))) continue;
    for (std::size_t f = 0; f < 4; ++f) {
      const CellIndex behind = mesh.neighbors()[c][f];
      if (behind == kNoCell || as_size(behind) < c || mesh.zero_volume(behind)) continue;
      const TetMesh::Tet& other = mesh.cells()[as_size(behind)];
      const auto& back = mesh.neighbors()[as_size(behind)];
      const auto g = as_size(std::find(back.begin(), back.end(), static_cast<CellIndex>(c)) - back.begin());
      if (g == back.size()) continue;
      // Seen from outside, the face of the one runs round against that of the other.
      const std::uint32_t a = mesh.cells()[c][kTetFaces[f][0]], b = mesh.cells()[c][kTetFaces[f][1]];
      for (std::size_t i = 0; i < 3; ++i)
        if (other[kTetFaces[g][i]] == a && other[kTetFaces[g][(i + 1) % 3]] == b) ++folded;
    }
  }
  return folded;
}

std::array<double, 6> dihedral_angles(const std::array<Vec3, 4>& corners) noexcept {
  std::array<Vec3, 4> normal;
  for (std::size_t f = 0; f < 4; ++f) {
    const Vec3& a = corners[kTetFaces[f][0]];
    normal[f] = glm::cross(corners[kTetFaces[f][1]] - a, corners[kTetFaces[f][2]] - a);
  }
  std::array<double, 6> angles{};
  std::size_t n = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = i + 1; j < 4; ++j, ++n) {
      // Both normals point out of the tetrahedron: the angle between the faces is what is left of a half
      // turn.
      const double across = glm::length(glm::cross(normal[i], normal[j])),
                   along = glm::dot(normal[i], normal[j]);
      angles[n] = across == 0.0 && along == 0.0 ? std::numeric_limits<double>::quiet_NaN()
                                                : std::atan2(across, -along) * 180.0 / std::numbers::pi;
    }
  }
  return angles;
}

MeshQuality mesh_quality(const TetMesh& mesh) {
  MeshQuality quality;
  quality.cells = mesh.cells().size();
  quality.zero_volume = mesh.zero_volume_count();
  std::vector<std::uint8_t> used(mesh.points().size(), 0);
  for (std::size_t c = 0; c < quality.cells; ++c) {
    std::array<Vec3, 4> corners;
    for (std::size_t i = 0; i < 4; ++i) {
      used[mesh.cells()[c][i]] = 1;
      corners[i] = mesh.points()[mesh.cells()[c][i]];
    }
    if (mesh.zero_volume(static_cast<CellIndex>(c))) {
      ++quality.slivers;
      continue;
    }
    quality.volume +=
        glm::determinant(Mat3{corners[1] - corners[0], corners[2] - corners[0], corners[3] - corners[0]}) /
        6.0;
    const auto angles = dihedral_angles(corners);
    const auto [least, largest] = std::minmax_element(angles.begin(), angles.end());
    ++quality.least_angles[step_of(*least)];
    ++quality.largest_angles[step_of(*largest)];
    quality.least_angle = std::min(quality.least_angle, *least);
    quality.largest_angle = std::max(quality.largest_angle, *largest);
    quality.slivers += *least < kSliverAngle || *largest > 180.0 - kSliverAngle ? 1 : 0;
  }
  quality.points = as_size(std::count(used.begin(), used.end(), std::uint8_t{1}));
  count_components(mesh, quality);
  count_border(mesh, quality);
  quality.folded_faces = folded_faces(mesh);
  return quality;
}

}  // namespace palpate
