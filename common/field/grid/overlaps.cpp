#include "common/field/grid/overlaps.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "common/base/index.h"
#include "common/base/parallel.h"
#include "common/field/grid/tet_shape.h"

namespace palpate {
namespace {

/// What lies this deep within a cell, in its barycentric coordinates, overlaps it.
constexpr double kDeep = 1e-3;

bool meet(const Box& a, const Box& b) {
  for (int axis = 0; axis < 3; ++axis) {
    if (a.upper[axis] < b.lower[axis] || b.upper[axis] < a.lower[axis]) return false;
  }
  return true;
}

Box box_of(const TetMesh& mesh, std::size_t cell) {
  Box box;
  for (const std::uint32_t v : mesh.cells()[cell]) box.include(mesh.points()[v]);
  return box;
}

/// Whether x lies in the cell, `deep` from its faces.
bool holds(const TetMesh& mesh, std::size_t cell, const Vec3& x, double deep) {
  if (mesh.zero_volume(static_cast<CellIndex>(cell))) return false;
  const Vec4 b = mesh.barycentric(static_cast<CellIndex>(cell), x);
  return std::min(std::min(b[0], b[1]), std::min(b[2], b[3])) >= deep;
}

class Search {
 public:
  Search(const TetMesh& mesh, std::span<const std::uint32_t> part, int threads)
      : mesh_(mesh),
        part_(part),
        threads_(threads),
        parts_(part.empty() ? 0 : *std::ranges::max_element(part) + 1U) {}

  Overlaps run() {
    Overlaps out;
    const std::vector<std::uint32_t> rank = ranks();
    std::vector<std::uint8_t> under(parts_, 0);  // parts that others of a lower rank overlap
    std::vector<std::uint8_t> any(parts_, 0);
    find_pairs(rank, under, any);
    out.parts = as_size(std::ranges::count(any, std::uint8_t{1}));
    if (out.parts == 0) return out;
    const std::size_t cells = mesh_.cells().size();
    out.rank.resize(cells);
    for (std::size_t c = 0; c < cells; ++c) out.rank[c] = rank[part_[c]];
    out.covered.assign(cells, 0);
    out.contested.assign(cells, 0);
    parallel_for(cells, threads_, [&](std::size_t first, std::size_t last) {
      for (std::size_t c = first; c < last; ++c) {
        if (under[part_[c]] != 0) judge(c, out);
      }
    });
    return out;
  }

 private:
  /// By the mean volume of cells.
  [[nodiscard]] std::vector<std::uint32_t> ranks() const {
    std::vector<double> volume(parts_, 0.0), cells(parts_, 0.0);
    for (std::size_t c = 0; c < part_.size(); ++c) {
      volume[part_[c]] += TetShape(mesh_.points().data(), mesh_.cells()[c]).volume6;
      cells[part_[c]] += 1.0;
    }
    for (std::size_t p = 0; p < parts_; ++p) volume[p] /= std::max(1.0, cells[p]);
    // Cells of one size differ by rounding.
    constexpr double kSame = 1e-9;
    const double largest = parts_ == 0 ? 0.0 : *std::ranges::max_element(volume);
    std::vector<std::uint32_t> order(parts_), rank(parts_);
    std::iota(order.begin(), order.end(), 0U);
    std::ranges::stable_sort(order, [&](std::uint32_t a, std::uint32_t b) {
      return std::floor(volume[a] / (kSame * largest)) < std::floor(volume[b] / (kSame * largest));
    });
    for (std::uint32_t r = 0; r < parts_; ++r) rank[order[r]] = r;
    return rank;
  }

  /// Looks from the border faces of each part a little inwards for cells of others.
  void find_pairs(const std::vector<std::uint32_t>& rank, std::vector<std::uint8_t>& under,
                  std::vector<std::uint8_t>& any) const {
    // Not alike to the corners: the middle lies on the diagonals of lattices with the same lines.
    constexpr std::array<double, 4> kInwards{0x1p-5, 0.29, 0.32, 0.35875};
    std::vector<std::uint32_t> over(part_.size(), kNone);  // by cell, a part that overlaps its own
    parallel_for(part_.size(), threads_, [&](std::size_t first, std::size_t last) {
      for (std::size_t c = first; c < last; ++c) {
        if (mesh_.zero_volume(static_cast<CellIndex>(c))) continue;
        for (int face = 0; face < 4; ++face) {
          if (mesh_.neighbors()[c][as_size(face)] != kNoCell) continue;
          Vec4 b(0.0);
          for (int i = 0; i < 4; ++i) b[(face + i) % 4] = kInwards[as_size(i)];
          const Vec3 x = mesh_.position(static_cast<CellIndex>(c), b);
          mesh_.visit_cells({x, x}, [&](std::size_t from, std::size_t to) {
            for (std::size_t d = from; d < to; ++d) {
              if (part_[d] != part_[c] && (over[c] == kNone || rank[part_[d]] < rank[over[c]]) &&
                  holds(mesh_, d, x, kDeep)) {
                over[c] = part_[d];
              }
            }
            return false;
          });
        }
      }
    });
    for (std::size_t c = 0; c < part_.size(); ++c) {
      if (over[c] == kNone) continue;
      any[part_[c]] = any[over[c]] = 1;
      under[rank[part_[c]] > rank[over[c]] ? part_[c] : over[c]] = 1;
    }
  }

  void judge(std::size_t c, Overlaps& out) const {
    const Box box = box_of(mesh_, c);
    Vec3 centre{0.0};
    for (const std::uint32_t v : mesh_.cells()[c]) centre += 0.25 * mesh_.points()[v];
    bool near = false, inside = false, at_border = false;
    mesh_.visit_cells(box, [&](std::size_t first, std::size_t last) {
      for (std::size_t d = first; d < last; ++d) {
        if (out.rank[d] >= out.rank[c] || !meet(box_of(mesh_, d), box)) continue;
        near = true;
        inside = inside || holds(mesh_, d, centre, 0.0);
        at_border = at_border || has_border_in(d, box);
      }
      return near && at_border;
    });
    out.covered[c] = inside && !at_border ? 1 : 0;
    out.contested[c] = near && out.covered[c] == 0 ? 1 : 0;
  }

  /// Whether a border face of the cell may come into a box.
  [[nodiscard]] bool has_border_in(std::size_t cell, const Box& box) const {
    for (std::size_t face = 0; face < 4; ++face) {
      if (mesh_.neighbors()[cell][face] != kNoCell) continue;
      Box of_face;
      for (std::size_t i = 1; i < 4; ++i)
        of_face.include(mesh_.points()[mesh_.cells()[cell][(face + i) % 4]]);
      if (meet(of_face, box)) return true;
    }
    return false;
  }

  static constexpr std::uint32_t kNone = 0xFFFFFFFFU;
  const TetMesh& mesh_;
  std::span<const std::uint32_t> part_;
  int threads_;
  std::size_t parts_;
};

}  // namespace

Overlaps find_overlaps(const TetMesh& mesh, std::span<const std::uint32_t> part, int threads) {
  return Search(mesh, part, threads).run();
}

std::vector<std::uint32_t> connected_parts(const TetMesh& mesh) {
  std::vector<std::uint32_t> root(mesh.points().size());
  std::iota(root.begin(), root.end(), 0U);
  const auto find = [&root](std::uint32_t p) {
    while (root[p] != p) p = root[p] = root[root[p]];
    return p;
  };
  for (const TetMesh::Tet& tet : mesh.cells()) {
    for (std::size_t i = 1; i < 4; ++i) {
      const std::uint32_t a = find(tet[0]), b = find(tet[i]);
      root[std::max(a, b)] = std::min(a, b);
    }
  }
  // Numbered as their points are in the file, of which cells have another order here.
  constexpr std::uint32_t kUnused = 0xFFFFFFFFU;
  std::vector<std::uint32_t> number(root.size(), kUnused), out(mesh.cells().size());
  for (std::size_t c = 0; c < out.size(); ++c) number[find(mesh.cells()[c][0])] = 0;
  std::uint32_t parts = 0;
  for (std::uint32_t& n : number) {
    if (n != kUnused) n = parts++;
  }
  for (std::size_t c = 0; c < out.size(); ++c) out[c] = number[find(mesh.cells()[c][0])];
  return out;
}

}  // namespace palpate
