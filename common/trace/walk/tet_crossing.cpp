#include "common/trace/walk/tet_crossing.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "common/base/index.h"

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

}  // namespace palpate
