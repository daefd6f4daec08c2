#include "common/trace/tet_crossing.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace palpate {

CellIndex sound_cell_beyond(const TetMesh& mesh, CellIndex flat, CellIndex from, const Vec3& x) {
  constexpr std::size_t kMaxCluster = 64;
  std::array<CellIndex, kMaxCluster> cluster{};
  std::size_t count = 0;
  cluster[count++] = flat;
  CellIndex best = kNoCell;
  double best_margin = -HUGE_VAL;
  for (std::size_t k = 0; k < count; ++k) {
    for (const CellIndex next : mesh.neighbors()[static_cast<std::size_t>(cluster[k])]) {
      if (next == kNoCell || next == from) continue;
      if (mesh.zero_volume(next)) {
        const auto* const end = cluster.begin() + count;
        if (count < kMaxCluster && std::find(cluster.cbegin(), end, next) == end) cluster[count++] = next;
        continue;
      }
      const Vec4 b = mesh.barycentric(next, x);
      const double margin = std::min(std::min(b[0], b[1]), std::min(b[2], b[3]));
      if (margin > best_margin) {
        best_margin = margin;
        best = next;
      }
    }
  }
  // A cell that the point misses by more than a flat cell's own coordinates are uncertain is not beyond it.
  constexpr double kMiss = -1e-6;
  return best_margin >= kMiss ? best : kNoCell;
}

}  // namespace palpate
