#include "common/field/grid/tet_mesh.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <string>
#include <tuple>

#include "common/base/check.h"
#include "common/base/error.h"
#include "common/base/index.h"
#include "common/base/ledger.h"
#include "common/base/memory.h"
#include "common/base/parallel.h"
#include "common/field/grid/tet_shape.h"

namespace palpate {
namespace {

/// Rounding of a coordinate, a few operations long, relative to the largest one.
constexpr double kRounding = 0x1p-50;
/// Cells that a walk may cross. Walks that begin at the index's cell need two or three; longer ones go in
/// circles among badly shaped cells, or come from a hint that is worth less than the index.
constexpr int kMaxWalk = 32;
/// A hint whose cell sees the point this many cell sizes away is not walked from.
constexpr double kFarHint = 16.0;

[[noreturn]] void refuse(const std::string& found, const std::string& expected) {
  throw input_error({.file = {}, .place = "cells", .found = found, .expected = expected, .remedy = {}});
}

/// Such a cell has no volume, and faces that are edges: it is nobody's neighbour.
bool repeats_vertex(const TetMesh::Tet& v) noexcept {
  return v[0] == v[1] || v[0] == v[2] || v[0] == v[3] || v[1] == v[2] || v[1] == v[3] || v[2] == v[3];
}

int least(const Vec4& b) noexcept {
  const int low = b[1] < b[0] ? 1 : 0;
  const int high = b[3] < b[2] ? 3 : 2;
  return b[high] < b[low] ? high : low;
}

}  // namespace

TetMesh::TetMesh(std::vector<Vec3> points, std::span<const Tet> cells, int threads)
    : points_(std::move(points)) {
  Work work("tetrahedra", "found by their neighbours and a tree of boxes");
  work.takes(points_.size() * sizeof(Vec3) + cells.size() * (sizeof(Tet) + sizeof(Neighbors)));
  if (cells.empty()) refuse("no tetrahedron", "at least one");
  if (cells.size() > as_size(std::numeric_limits<CellIndex>::max()) - 1) {
    refuse(std::to_string(cells.size()) + " tetrahedra", "at most 2^31 - 2");
  }
  std::vector<std::uint8_t> used(points_.size(), 0);
  for (std::size_t c = 0; c < cells.size(); ++c) {
    for (const std::uint32_t v : cells[c]) {
      if (v >= points_.size()) {
        refuse("tetrahedron " + std::to_string(c) + " has the vertex " + std::to_string(v),
               "a number below " + std::to_string(points_.size()));
      }
      if (!is_finite(points_[v])) {
        refuse("vertex " + std::to_string(v) + " is not finite", "finite coordinates");
      }
      bounds_.include(points_[v]);
      used_point_count_ += used[v] == 0 ? 1 : 0;
      used[v] = 1;
    }
  }
  for (int axis = 0; axis < 3; ++axis) {
    slack_ = std::max({slack_, std::abs(bounds_.lower[axis]), std::abs(bounds_.upper[axis])});
  }
  slack_ *= kRounding;

  tree_ = CellTree(points_, cells, bounds_, threads);
  cell_order_ = tree_.take_order();
  cells_.resize(cells.size());
  parallel_for(cells.size(), threads, [&](std::size_t first, std::size_t last) {
    for (std::size_t c = first; c < last; ++c) cells_[c] = cells[cell_order_[c]];
  });
  find_neighbors(orient_cells(threads), threads);
  tree_.finish(points_, cells_, threads);
  const bool single = std::ranges::all_of(points_, [](const Vec3& x) {
    return x.x == static_cast<float>(x.x) && x.y == static_cast<float>(x.y) && x.z == static_cast<float>(x.z);
  });
  if (single) {
    fill_steps(single_steps_, threads);
  } else {
    fill_steps(double_steps_, threads);
  }
}

template <typename T>
void TetMesh::fill_steps(LargeVector<Step<T>>& steps, int threads) {
  steps.reserve(cells_.size());
  make_resident(steps.data(), cells_.size() * sizeof(Step<T>), threads);
  steps.resize(cells_.size());
  parallel_for(cells_.size(), threads, [&](std::size_t first, std::size_t last) {
    for (std::size_t c = first; c < last; ++c) {
      for (std::size_t i = 0; i < 4; ++i) {
        const Vec3& x = points_[cells_[c][i]];
        steps[c].x[i] = {static_cast<T>(x.x), static_cast<T>(x.y), static_cast<T>(x.z)};
      }
      steps[c].behind = neighbors_[c];
    }
  });
}

std::vector<std::uint8_t> TetMesh::orient_cells(int threads) {
  std::vector<std::uint8_t> turned(cells_.size(), 0);
  zero_volume_.assign(cells_.size(), 0);
  std::atomic<std::size_t> inverted{0};
  std::atomic<std::size_t> flat{0};
  parallel_for(cells_.size(), threads, [&](std::size_t first, std::size_t last) {
    std::size_t inverted_here = 0;
    std::size_t flat_here = 0;
    for (std::size_t c = first; c < last; ++c) {
      const TetShape shape(points_.data(), cells_[c]);
      if (shape.flat()) {
        zero_volume_[c] = 1;
        ++flat_here;
      } else if (shape.volume6 < 0.0) {
        std::swap(cells_[c][2], cells_[c][3]);
        turned[c] = 1;
        ++inverted_here;
      }
    }
    inverted += inverted_here;
    flat += flat_here;
  });
  inverted_count_ = inverted;
  zero_volume_count_ = flat;
  return turned;
}

bool TetMesh::lies_over(std::uint32_t a, std::uint32_t b, const std::array<std::uint32_t, 3>& face,
                        const std::vector<std::uint8_t>& turned) const {
  if (zero_volume_[a] != 0 || zero_volume_[b] != 0 || turned[a] != turned[b]) return false;
  const Vec3 x = points_[face[0]];
  const Vec3 normal = glm::cross(points_[face[1]] - x, points_[face[2]] - x);
  const auto side = [&](std::uint32_t cell) {
    const Tet& v = cells_[cell];
    const auto* const apex =
        std::ranges::find_if(v, [&](std::uint32_t n) { return std::ranges::count(face, n) == 0; });
    return glm::dot(points_[*apex] - x, normal) > 0.0;
  };
  return side(a) == side(b);
}

void TetMesh::find_neighbors(const std::vector<std::uint8_t>& turned, int threads) {
  // Faces are gathered by their smallest vertex; those of one vertex are few and sorted by the other two.
  struct Face {
    std::uint32_t middle;
    std::uint32_t largest;
    std::uint32_t cell;
  };
  const auto sorted_face = [](const Tet& cell, std::size_t opposite) {
    std::array<std::uint32_t, 3> v{cell[(opposite + 1) % 4], cell[(opposite + 2) % 4],
                                   cell[(opposite + 3) % 4]};
    if (v[0] > v[1]) std::swap(v[0], v[1]);
    if (v[1] > v[2]) std::swap(v[1], v[2]);
    if (v[0] > v[1]) std::swap(v[0], v[1]);
    return v;
  };

  std::vector<std::size_t> begin(points_.size() + 1, 0);
  for (const Tet& cell : cells_) {
    if (repeats_vertex(cell)) continue;
    for (std::size_t i = 0; i < 4; ++i) ++begin[sorted_face(cell, i)[0] + 1];
  }
  for (std::size_t v = 0; v < points_.size(); ++v) begin[v + 1] += begin[v];
  std::vector<Face> faces(begin.back());
  std::vector<std::size_t> next(begin.begin(), begin.end() - 1);
  for (std::size_t c = 0; c < cells_.size(); ++c) {
    if (repeats_vertex(cells_[c])) continue;
    for (std::size_t i = 0; i < 4; ++i) {
      const auto v = sorted_face(cells_[c], i);
      faces[next[v[0]]++] = {v[1], v[2], static_cast<std::uint32_t>(c)};
    }
  }

  neighbors_.assign(cells_.size(), Neighbors{kNoCell, kNoCell, kNoCell, kNoCell});
  std::atomic<std::size_t> overlapping{0};
  parallel_for(points_.size(), threads, [&](std::size_t first, std::size_t last) {
    const auto place = [&](const Face& face, std::uint32_t smallest) -> CellIndex& {
      const Tet& cell = cells_[face.cell];
      std::size_t opposite = 0;
      while (cell[opposite] == smallest || cell[opposite] == face.middle || cell[opposite] == face.largest) {
        ++opposite;
      }
      return neighbors_[face.cell][opposite];
    };
    for (std::size_t v = first; v < last; ++v) {
      const std::span<Face> around(faces.data() + begin[v], begin[v + 1] - begin[v]);
      std::ranges::sort(around, [](const Face& a, const Face& b) {
        return std::tuple(a.middle, a.largest, a.cell) < std::tuple(b.middle, b.largest, b.cell);
      });
      for (std::size_t i = 0; i < around.size();) {
        std::size_t end = i + 1;
        while (end < around.size() && around[end].middle == around[i].middle &&
               around[end].largest == around[i].largest) {
          ++end;
        }
        std::span<Face> sharing = around.subspan(i, end - i);
        if (sharing.size() > 2) {
          // Zero-volume cells, of which polyhedra with coplanar faces have equal ones, give way to others.
          const auto rest = std::partition(sharing.begin(), sharing.end(),
                                           [this](const Face& face) { return zero_volume_[face.cell] == 0; });
          sharing = sharing.first(as_size(rest - sharing.begin()));
        }
        const auto smallest = static_cast<std::uint32_t>(v);
        const std::array<std::uint32_t, 3> face{smallest, around[i].middle, around[i].largest};
        bool over = sharing.size() > 2;
        // Each with the first one across that is still alone.
        for (std::size_t a = 0; a < sharing.size(); ++a) {
          for (std::size_t b = a + 1; b < sharing.size() && place(sharing[a], smallest) == kNoCell; ++b) {
            if (place(sharing[b], smallest) != kNoCell) continue;
            if (lies_over(sharing[a].cell, sharing[b].cell, face, turned)) {
              over = true;
              continue;
            }
            place(sharing[a], smallest) = static_cast<CellIndex>(sharing[b].cell);
            place(sharing[b], smallest) = static_cast<CellIndex>(sharing[a].cell);
          }
        }
        if (over) ++overlapping;
        i = end;
      }
    }
  });
  overlapping_face_count_ = overlapping;
}

void TetMesh::close(CellIndex cell, int face) {
  if (walls_.empty()) walls_.assign(cells_.size(), 0);
  const auto c = as_size(cell);
  walls_[c] = static_cast<std::uint8_t>(walls_[c] | (1U << static_cast<unsigned>(face)));
  neighbors_[c][as_size(face)] = kNoCell;
}

Vec4 TetMesh::barycentric(CellIndex cell, const Vec3& x) const noexcept {
  PALPATE_ASSERT(!zero_volume(cell));
  const Tet& v = cells_[as_size(cell)];
  return TetShape(points_.data(), v).barycentric(x - points_[v[0]]);
}

Mat3 TetMesh::barycentric_gradients(CellIndex cell) const noexcept {
  PALPATE_ASSERT(!zero_volume(cell));
  const TetShape shape(points_.data(), cells_[as_size(cell)]);
  const double inverse = 1.0 / shape.volume6;
  return {shape.n1 * inverse, shape.n2 * inverse, shape.n3 * inverse};
}

Vec3 TetMesh::position(CellIndex cell, const Vec4& b) const noexcept {
  const Tet& v = cells_[as_size(cell)];
  return b[0] * points_[v[0]] + b[1] * points_[v[1]] + b[2] * points_[v[2]] + b[3] * points_[v[3]];
}

bool TetMesh::locate(const Vec3& x, CellIndex hint, TetPoint& found) const noexcept {
  for (int axis = 0; axis < 3; ++axis) {
    // False for NaN.
    if (!(x[axis] >= bounds_.lower[axis] - slack_ && x[axis] <= bounds_.upper[axis] + slack_)) return false;
  }
  constexpr double kAnyDistance = std::numeric_limits<double>::infinity();
  const bool hinted = hint >= 0 && as_size(hint) < cells_.size() && walk(x, hint, kFarHint, found);
  if (!hinted && !walk(x, static_cast<CellIndex>(tree_.near(x)), kAnyDistance, found) && !search(x, found)) {
    return false;
  }
  if (!rank_.empty() && contested_[as_size(found.cell)] != 0) take_first_rank(x, found);
  return true;
}

void TetMesh::rank_cells(std::vector<std::uint32_t> rank, std::vector<std::uint8_t> contested) {
  PALPATE_CHECK(rank.size() == cells_.size() && contested.size() == cells_.size());
  rank_ = std::move(rank);
  contested_ = std::move(contested);
}

void TetMesh::take_first_rank(const Vec3& x, TetPoint& found) const noexcept {
  tree_.visit_leaves(x, x, [&](std::size_t first, std::size_t last) {
    for (std::size_t c = first; c < last; ++c) {
      if (rank_[c] >= rank_[as_size(found.cell)] || zero_volume_[c] != 0) continue;
      const Vec4 b = barycentric(static_cast<CellIndex>(c), x);
      if (b[least(b)] >= 0.0) found = {static_cast<CellIndex>(c), b};
    }
    return false;
  });
}

bool TetMesh::walk(const Vec3& x, CellIndex start, double farthest, TetPoint& found) const noexcept {
  return single_steps_.empty() ? walk_over(double_steps_, x, start, farthest, found)
                               : walk_over(single_steps_, x, start, farthest, found);
}

template <typename T>
bool TetMesh::walk_over(const LargeVector<Step<T>>& steps, const Vec3& x, CellIndex start, double farthest,
                        TetPoint& found) const noexcept {
  CellIndex cell = start;
  for (int step = 0; step < kMaxWalk; ++step) {
    const auto c = as_size(cell);
    if (zero_volume_count_ != 0 && zero_volume_[c] != 0) return false;
    const Step<T>& here = steps[c];
    // Whoever located a point reads its cell's vertices next; else the walk goes on behind a face.
    __builtin_prefetch(cells_.data() + c);
    for (const CellIndex other : here.behind) __builtin_prefetch(steps.data() + std::max(other, 0));
    const auto corner = [&here](std::size_t i) { return Vec3(here.x[i][0], here.x[i][1], here.x[i][2]); };
    const Vec3 x0 = corner(0);
    const TetShape shape(x0, corner(1), corner(2), corner(3));
    const Vec4 b = shape.barycentric(x - x0);
    int face = least(b);
    if (b[face] >= 0.0) {
      found = {cell, b};
      return true;
    }
    // Outside by less than rounding counts as inside: the distance to the plane of face i is
    // |b_i| volume6 / |n_i|. The walk leaves by the least coordinate among faces farther than that.
    const auto beyond = [&](int i) {
      const double outside = b[i] * shape.volume6;
      return b[i] < 0.0 && outside * outside > slack_ * slack_ * shape.area2(i);
    };
    if (!beyond(face)) {
      int other = -1;
      for (int i = 0; i < 4; ++i) {
        if (beyond(i) && (other < 0 || b[i] < b[other])) other = i;
      }
      if (other < 0) {
        found = {cell, b};
        return true;
      }
      face = other;
    }
    if (step == 0 && b[face] < -farthest) return false;
    cell = here.behind[as_size(face)];
    if (cell == kNoCell) return false;
  }
  return false;
}

bool TetMesh::search(const Vec3& x, TetPoint& found) const noexcept {
  // Among cells that see x outside by rounding alone, the one that sees it least outside is taken.
  double best = std::numeric_limits<double>::infinity();  // distance outside / tolerated distance
  bool inside = false;
  double flat_edge2 = 0.0;  // longest edge of a zero-volume cell near x
  TetPoint nearest;
  double nearest_outside = std::numeric_limits<double>::infinity();
  tree_.visit_leaves(x, x, [&](std::size_t first, std::size_t last) {
    for (std::size_t c = first; c < last; ++c) {
      const Tet& v = cells_[c];
      const TetShape shape(points_.data(), v);
      const double edge2 = shape.longest_edge2();
      if (zero_volume_[c] != 0) {
        flat_edge2 = std::max(flat_edge2, edge2);
        continue;
      }
      const Vec4 b = shape.barycentric(x - points_[v[0]]);
      if (b[least(b)] >= 0.0) {
        found = {static_cast<CellIndex>(c), b};
        inside = true;
        return true;
      }
      // Rounding of the face's normal grows as the face gets narrow: edge^2 / area2.
      double worst = 0.0;
      double distance = 0.0;
      for (int i = 0; i < 4; ++i) {
        if (b[i] >= 0.0) continue;
        const double area = std::sqrt(shape.area2(i));
        const double outside = -b[i] * shape.volume6 / area;
        const double tolerated = slack_ + kRounding * std::sqrt(edge2) * (edge2 / area);
        worst = std::max(worst, outside / tolerated);
        distance = std::max(distance, outside);
      }
      if (worst < best) {
        best = worst;
        found = {static_cast<CellIndex>(c), b};
      }
      if (distance < nearest_outside) {
        nearest_outside = distance;
        nearest = {static_cast<CellIndex>(c), b};
      }
    }
    return false;
  });
  if (inside || best <= 1.0) return true;
  // Inside a zero-volume cell the nearest proper cell answers: it is as near as that cell is flat.
  constexpr double kFlatStack = 4.0;
  if (flat_edge2 > 0.0 && nearest_outside <= kFlatStack * TetShape::kFlat * std::sqrt(flat_edge2)) {
    found = nearest;
    return true;
  }
  return false;
}

}  // namespace palpate
