#include "common/field/grid/tet_seams.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>

#include "common/base/index.h"
#include "common/base/parallel.h"

namespace palpate {
namespace {

/// Steps behind a face, as parts of its longest edge: beyond rounding; over the gap of points that are joined
/// where they are this close (kMergeDistance); over that between the chords of a curved interface (h^2 / 8 R).
constexpr std::array<double, 3> kSteps{0x1p-20, 0x1p-10, 0x1p-6};
/// And a step is at least this part of the coordinates.
constexpr double kBeyondRounding = 0x1p-44;
/// What lies this deep within a cell, in its barycentric coordinates, overlaps it.
constexpr double kDeep = 1e-3;

}  // namespace

FaceNormal face_normal(const TetMesh& mesh, CellIndex cell, int face) noexcept {
  const TetMesh::Tet& v = mesh.cells()[as_size(cell)];
  const auto corner = [&](int i) { return mesh.points()[v[as_size((face + i) % 4)]]; };
  const Vec3 e = corner(2) - corner(1), f = corner(3) - corner(1), g = f - e;
  FaceNormal out;
  out.size = std::sqrt(std::max(glm::dot(e, e), std::max(glm::dot(f, f), glm::dot(g, g))));
  const Vec3 normal = glm::cross(e, f);
  const double area = glm::length(normal);
  if (area > 0.0) out.outward = normal / (glm::dot(normal, corner(0) - corner(1)) > 0.0 ? -area : area);
  return out;
}

CellBehind cell_behind(const TetMesh& mesh, CellIndex cell, int face, const Vec3& x) noexcept {
  if (mesh.closed(cell, face)) return {};
  const FaceNormal normal = face_normal(mesh, cell, face);
  const double rounding = kBeyondRounding * std::max(std::abs(x.x), std::max(std::abs(x.y), std::abs(x.z)));
  for (const double part : kSteps) {
    TetPoint found;
    const Vec3 behind = x + std::max(part * normal.size, rounding) * normal.outward;
    if (mesh.locate(behind, kNoCell, found) && found.cell != cell) return {found.cell, part};
  }
  return {};
}

Seams find_seams(const TetMesh& mesh, int threads) {
  std::atomic<std::size_t> border{0}, faces{0}, gaps{0}, overlapping{0};
  parallel_for(mesh.cells().size(), threads, [&](std::size_t first, std::size_t last) {
    Seams here;
    for (std::size_t c = first; c < last; ++c) {
      const auto cell = static_cast<CellIndex>(c);
      if (mesh.zero_volume(cell)) continue;
      for (int face = 0; face < 4; ++face) {
        if (mesh.neighbors()[c][as_size(face)] != kNoCell) continue;
        ++here.border_faces;
        Vec4 b(1.0 / 3.0);
        b[face] = 0.0;
        const Vec3 x = mesh.position(cell, b);
        const CellBehind behind = cell_behind(mesh, cell, face, x);
        if (behind.cell == kNoCell) continue;
        ++here.faces;
        if (behind.step > kSteps[0]) ++here.over_gaps;
        const Vec4 there = mesh.barycentric(behind.cell, x);
        if (std::min(std::min(there[0], there[1]), std::min(there[2], there[3])) > kDeep) ++here.overlapping;
      }
    }
    border += here.border_faces;
    faces += here.faces;
    gaps += here.over_gaps;
    overlapping += here.overlapping;
  });
  return {.border_faces = border, .faces = faces, .over_gaps = gaps, .overlapping = overlapping};
}

}  // namespace palpate
