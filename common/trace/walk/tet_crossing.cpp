#include "common/trace/walk/tet_crossing.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "common/base/index.h"
#include "common/field/grid/tet_seams.h"

namespace palpate {

CellIndex sound_cell_beyond(const TetMesh& mesh, CellIndex flat, CellIndex from, const Vec3& x) {
  constexpr std::size_t kMaxCluster = 64;
  std::array<CellIndex, kMaxCluster> cluster{};
  std::size_t count = 0;
  cluster[count++] = flat;
  // At a vertex of the flat cells those on the near side hold the point as well as those beyond.
  const TetMesh::Neighbors& around = mesh.neighbors()[as_size(from)];
  const auto* const left_by = std::find(around.cbegin(), around.cend(), flat);
  const auto near_side = [&](CellIndex cell) {
    Vec3 centre{0.0};
    for (const std::uint32_t v : mesh.cells()[as_size(cell)]) centre += 0.25 * mesh.points()[v];
    return left_by != around.cend() &&
           mesh.barycentric(from, centre)[static_cast<int>(left_by - around.cbegin())] > 0.0;
  };
  struct Best {
    CellIndex cell = kNoCell;
    double margin = -HUGE_VAL;
  };
  Best beyond, near;
  for (std::size_t k = 0; k < count; ++k) {
    for (const CellIndex next : mesh.neighbors()[as_size(cluster[k])]) {
      if (next == kNoCell || next == from) continue;
      if (mesh.zero_volume(next)) {
        const auto* const end = cluster.begin() + count;
        if (count < kMaxCluster && std::find(cluster.cbegin(), end, next) == end) cluster[count++] = next;
        continue;
      }
      const Vec4 b = mesh.barycentric(next, x);
      const double margin = std::min(std::min(b[0], b[1]), std::min(b[2], b[3]));
      Best& best = near_side(next) ? near : beyond;
      if (margin > best.margin) best = {next, margin};
    }
  }
  // A cell that the point misses by more than a flat cell's own coordinates are uncertain is not beyond it.
  constexpr double kMiss = -1e-6;
  if (beyond.margin >= kMiss) return beyond.cell;
  return near.margin >= kMiss ? near.cell : kNoCell;
}

namespace {

Vec3 velocity_at(const ExactMesh& mesh, CellIndex cell, const Vec4& b) {
  Vec3 v{0.0};
  for (int i = 0; i < 4; ++i) {
    const PackedVertex& vertex = mesh.vertices()[mesh.mesh().cells()[as_size(cell)][as_size(i)]];
    v += b[i] * Vec3(vertex.v[0], vertex.v[1], vertex.v[2]);
  }
  return v;
}

/// Whether the velocity is the same all over the cell.
bool is_constant(const ExactMesh& mesh, CellIndex cell) {
  const TetMesh::Tet& tet = mesh.mesh().cells()[as_size(cell)];
  const auto& first = mesh.vertices()[tet[0]].v;
  for (std::size_t i = 1; i < tet.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      if (mesh.vertices()[tet[i]].v[axis] != first[axis]) return false;
    }
  }
  return true;
}

/// Whether another cell counts at x, on a face of `cell`, though it is in this one: blocks overlap there (overlaps.h).
bool gives_way(const TetMesh& mesh, CellIndex cell, const FaceNormal& face, const Vec3& x) {
  constexpr double kInwards = 0x1p-20;
  TetPoint found;
  return mesh.locate(x - (kInwards * face.size) * face.outward, cell, found) && found.cell != cell;
}

/// The nearest coordinates that a point of the cell has, nearly.
Vec4 clamped(const Vec4& b) {
  const Vec4 kept = glm::max(b, Vec4(0.0));
  return kept / (kept[0] + kept[1] + kept[2] + kept[3]);
}

}  // namespace

Vec3 SeamCrossing::carried(const Vec3& e) const noexcept {
  const Vec3 more = jump * glm::dot(lever, e);
  const double length = glm::length(more);
  return e + (length > longest ? more * (longest / length) : more);
}

SeamCrossing cross_seam(const ExactMesh& mesh, CellIndex from, int face, const Vec3& x, double sign,
                        int stuck) {
  const TetMesh& tets = mesh.mesh();
  SeamCrossing out;
  out.cell = cell_behind(tets, from, face, x).cell;
  if (out.cell == kNoCell) return out;
  Vec4 b = clamped(tets.barycentric(out.cell, x));
  const Vec3 before = sign * velocity_at(mesh, from, clamped(tets.barycentric(from, x)));
  out.v = sign * velocity_at(mesh, out.cell, b);

  constexpr int kStuck = 4;
  constexpr double kNudge = 0x1p-10;
  const FaceNormal face_of = face_normal(tets, from, face);
  const bool constant =
      is_constant(mesh, from) && is_constant(mesh, out.cell) && !gives_way(tets, from, face_of, x);
  const double towards = glm::dot(before, face_of.outward);
  if (constant && towards > 0.0 && glm::dot(out.v, face_of.outward) < 0.0) {
    out.opposed = true;
    return out;
  }
  if (!constant && stuck >= kStuck && glm::dot(out.v, face_of.outward) < 0.0) {
    b = clamped(tets.barycentric(out.cell, x + (kNudge * face_of.size) * face_of.outward));
    out.v = sign * velocity_at(mesh, out.cell, b);
  }
  out.x = tets.position(out.cell, b);
  out.error = glm::distance(out.x, x);
  if (constant) {
    if (towards > 0.0 && stuck == 0) {
      out.jump = out.v - before;
      out.lever = face_of.outward / towards;
      out.longest = face_of.size;
    }
    return out;
  }
  const double jump = glm::distance(before, out.v), speed = glm::length(before);
  // Values that are no numbers end the line, elsewhere.
  if (jump > 0.0 && stuck == 0) out.error += face_of.size * (jump < speed ? jump / speed : 1.0);
  return out;
}

}  // namespace palpate
