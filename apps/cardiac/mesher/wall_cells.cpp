#include "apps/cardiac/mesher/wall_cells.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_set>

#include "common/base/index.h"

namespace palpate {
namespace {

/// A point this part of a cell's volume outside one of its faces still counts as inside: rounding.
constexpr double kOnFace = 1e-12;

double six_volumes(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  return glm::dot(glm::cross(b - a, c - a), d - a);
}

/// The least height over the longest edge.
double flatness(std::span<const Vec3> points, const TetMesh::Tet& tet) {
  double area = 0.0, longest = 0.0;
  for (const auto& face : kTetFaces) {
    const Vec3& a = points[tet[face[0]]];
    area = std::max(area, glm::length(glm::cross(points[tet[face[1]]] - a, points[tet[face[2]]] - a)));
  }
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = i + 1; j < 4; ++j)
      longest = std::max(longest, glm::distance(points[tet[i]], points[tet[j]]));
  const double volume = std::abs(six_volumes(points[tet[0]], points[tet[1]], points[tet[2]], points[tet[3]]));
  return area * longest > 0.0 ? volume / (area * longest) : 0.0;
}

/// Takes slivers off the border until there is none that may go.
class BorderPeel {
 public:
  BorderPeel(std::span<const Vec3> points, const DelaunayCells& cells, std::vector<std::uint8_t>& kept)
      : points_(points), cells_(cells), kept_(kept) {
    for (std::size_t c = 0; c < kept.size(); ++c) {
      if (kept[c] == 0) continue;
      for (std::size_t f = 0; f < 4; ++f)
        if (open(c, f)) add_edges(c, f);
    }
  }

  std::uint64_t run() {
    std::vector<std::size_t> waiting;
    for (std::size_t c = 0; c < kept_.size(); ++c)
      if (kept_[c] != 0) waiting.push_back(c);
    std::uint64_t taken = 0;
    while (!waiting.empty()) {
      const std::size_t c = waiting.back();
      waiting.pop_back();
      if (!may_go(c)) continue;
      kept_[c] = 0;
      ++taken;
      for (std::size_t f = 0; f < 4; ++f) {
        const CellIndex behind = cells_.neighbors[c][f];
        if (behind == kNoCell || kept_[as_size(behind)] == 0) continue;
        add_edges(c, f);  // now on the border, from the other side
        waiting.push_back(as_size(behind));
      }
    }
    return taken;
  }

 private:
  [[nodiscard]] bool open(std::size_t c, std::size_t f) const {
    const CellIndex behind = cells_.neighbors[c][f];
    return behind == kNoCell || kept_[as_size(behind)] == 0;
  }
  void add_edges(std::size_t c, std::size_t f) {
    const TetMesh::Tet& tet = cells_.tets[c];
    for (std::size_t i = 0; i < 3; ++i)
      border_.insert(pair_key(tet[kTetFaces[f][i]], tet[kTetFaces[f][(i + 1) % 3]]));
  }
  [[nodiscard]] bool may_go(std::size_t c) const {
    if (kept_[c] == 0) return false;
    // Faces are named by the corner they leave out: two open ones share the edge of the other two corners,
    // and taking the tetrahedron off lays bare the edge between their own.
    std::array<std::size_t, 4> bare{};
    std::size_t count = 0;
    for (std::size_t f = 0; f < 4; ++f)
      if (open(c, f)) bare[count++] = f;
    if (count != 2 || flatness(points_, cells_.tets[c]) >= kSliver) return false;
    return border_.count(pair_key(cells_.tets[c][bare[0]], cells_.tets[c][bare[1]])) == 0;
  }

  std::span<const Vec3> points_;
  const DelaunayCells& cells_;
  std::vector<std::uint8_t>& kept_;
  std::unordered_set<std::uint64_t> border_;  ///< edges; those that went off stay: they are met no more
};

/// Takes off what no face joins to a larger part: a few tetrahedra that a corner or an edge holds.
std::uint64_t drop_islands(const DelaunayCells& cells, std::vector<std::uint8_t>& kept) {
  std::vector<std::vector<std::size_t>> parts;
  std::vector<std::uint8_t> seen(kept.size(), 0);
  std::size_t all = 0;
  for (std::size_t start = 0; start < kept.size(); ++start) {
    if (kept[start] == 0 || seen[start] != 0) continue;
    std::vector<std::size_t> part{start};
    seen[start] = 1;
    for (std::size_t i = 0; i < part.size(); ++i) {
      for (const CellIndex next : cells.neighbors[part[i]]) {
        const auto n = as_size(next);
        if (next == kNoCell || kept[n] == 0 || seen[n] != 0) continue;
        seen[n] = 1;
        part.push_back(n);
      }
    }
    all += part.size();
    // Large parts stay, and need not be remembered.
    if (static_cast<double>(part.size()) < kIsland * static_cast<double>(kept.size()))
      parts.push_back(std::move(part));
  }
  std::uint64_t dropped = 0;
  for (const auto& part : parts) {
    if (static_cast<double>(part.size()) >= kIsland * static_cast<double>(all)) continue;
    dropped += part.size();
    for (const std::size_t c : part) kept[c] = 0;
  }
  return dropped;
}

}  // namespace

WallCells::WallCells(const SampledWall& wall) : wall_(wall) {
  for (std::size_t t = 0; t < wall.tets.size(); ++t)
    if (t == 0 || wall.cell_of_tet[t] != wall.cell_of_tet[t - 1])
      first_tet_.push_back(static_cast<std::uint32_t>(t));
  first_tet_.push_back(static_cast<std::uint32_t>(wall.tets.size()));

  // Two passes over the corners of every cell: count, then fill.
  std::vector<std::uint32_t> last(wall.points.size(), std::numeric_limits<std::uint32_t>::max());
  first_cell_.assign(wall.points.size() + 1, 0);
  const auto each_corner = [&](const auto& visit) {
    std::fill(last.begin(), last.end(), std::numeric_limits<std::uint32_t>::max());
    for (std::uint32_t cell = 0; cell + 1 < first_tet_.size(); ++cell) {
      for (std::size_t t = first_tet_[cell]; t < first_tet_[cell + 1]; ++t) {
        for (const std::uint32_t p : wall.tets[t]) {
          if (last[p] == cell) continue;
          last[p] = cell;
          visit(p, cell);
        }
      }
    }
  };
  each_corner([&](std::uint32_t p, std::uint32_t) { ++first_cell_[p + 1]; });
  for (std::size_t p = 0; p < wall.points.size(); ++p) first_cell_[p + 1] += first_cell_[p];
  cell_of_point_.resize(first_cell_.back());
  std::vector<std::uint32_t> next(first_cell_.begin(), first_cell_.end() - 1);
  each_corner([&](std::uint32_t p, std::uint32_t cell) { cell_of_point_[next[p]++] = cell; });
  for (const Vec3& x : wall.points) bounds_.include(x);
  make_bins();
}

void WallCells::make_bins() {
  const std::size_t cells = first_tet_.size() - 1;
  const Vec3 size = bounds_.upper - bounds_.lower;
  // As many bins as cells, if cells filled the box.
  const double side = std::cbrt(std::max(size.x * size.y * size.z, 1e-300) /
                                std::max<double>(1.0, static_cast<double>(cells)));
  for (int a = 0; a < 3; ++a) {
    const double count = side > 0.0 ? std::clamp(size[a] / side, 1.0, 1024.0) : 1.0;
    bins_[as_size(a)] = static_cast<std::int64_t>(count);
    per_length_[a] = size[a] > 0.0 ? std::floor(count) / size[a] : 0.0;
  }
  const auto each_bin = [&](const auto& visit) {
    for (std::size_t cell = 0; cell < cells; ++cell) {
      Box box;
      for (std::size_t t = first_tet_[cell]; t < first_tet_[cell + 1]; ++t)
        for (const std::uint32_t p : wall_.tets[t]) box.include(wall_.points[p]);
      const auto low = bin_of(box.lower), high = bin_of(box.upper);
      for (std::int64_t k = low[2]; k <= high[2]; ++k)
        for (std::int64_t j = low[1]; j <= high[1]; ++j)
          for (std::int64_t i = low[0]; i <= high[0]; ++i)
            visit(as_size(i + bins_[0] * (j + bins_[1] * k)), static_cast<std::uint32_t>(cell));
    }
  };
  first_in_bin_.assign(as_size(bins_[0] * bins_[1] * bins_[2]) + 1, 0);
  each_bin([&](std::size_t bin, std::uint32_t) { ++first_in_bin_[bin + 1]; });
  for (std::size_t b = 1; b < first_in_bin_.size(); ++b) first_in_bin_[b] += first_in_bin_[b - 1];
  in_bin_.resize(first_in_bin_.back());
  std::vector<std::uint32_t> next(first_in_bin_.begin(), first_in_bin_.end() - 1);
  each_bin([&](std::size_t bin, std::uint32_t cell) { in_bin_[next[bin]++] = cell; });
}

std::array<std::int64_t, 3> WallCells::bin_of(const Vec3& x) const noexcept {
  std::array<std::int64_t, 3> bin{};
  for (int a = 0; a < 3; ++a) {
    const std::int64_t most = bins_[as_size(a)] - 1;
    bin[as_size(a)] = std::clamp(static_cast<std::int64_t>((x[a] - bounds_.lower[a]) * per_length_[a]),
                                 std::int64_t{0}, most);
  }
  return bin;
}

bool WallCells::share_cell(const TetMesh::Tet& tet) const noexcept {
  const auto cells_of = [this](std::uint32_t p) {
    return std::span(cell_of_point_).subspan(first_cell_[p], first_cell_[p + 1] - first_cell_[p]);
  };
  // The corner with the fewest cells names those that come into question.
  std::size_t least = 0;
  for (std::size_t i = 1; i < 4; ++i)
    if (cells_of(tet[i]).size() < cells_of(tet[least]).size()) least = i;
  const auto candidates = cells_of(tet[least]);
  return std::any_of(candidates.begin(), candidates.end(), [&](std::uint32_t cell) {
    return std::all_of(tet.begin(), tet.end(), [&](std::uint32_t p) {
      const auto of = cells_of(p);
      return std::binary_search(of.begin(), of.end(), cell);
    });
  });
}

bool WallCells::cell_holds(std::size_t cell, const Vec3& x) const noexcept {
  for (std::size_t t = first_tet_[cell]; t < first_tet_[cell + 1]; ++t) {
    std::array<Vec3, 4> at;
    for (std::size_t i = 0; i < 4; ++i) at[i] = wall_.points[wall_.tets[t][i]];
    const double volume = six_volumes(at[0], at[1], at[2], at[3]);
    if (volume == 0.0) continue;
    bool inside = true;
    for (std::size_t i = 0; inside && i < 4; ++i) {
      std::array<Vec3, 4> moved = at;
      moved[i] = x;
      inside = six_volumes(moved[0], moved[1], moved[2], moved[3]) / volume >= -kOnFace;
    }
    if (inside) return true;
  }
  return false;
}

bool WallCells::hold(const Vec3& x) const noexcept {
  for (int a = 0; a < 3; ++a)
    if (!(x[a] >= bounds_.lower[a] && x[a] <= bounds_.upper[a])) return false;
  const auto at = bin_of(x);
  const auto bin = as_size(at[0] + bins_[0] * (at[1] + bins_[1] * at[2]));
  for (std::size_t i = first_in_bin_[bin]; i < first_in_bin_[bin + 1]; ++i)
    if (cell_holds(in_bin_[i], x)) return true;
  return false;
}

std::vector<double> point_spacing(const SampledWall& wall) {
  constexpr double kNone = std::numeric_limits<double>::infinity();
  std::vector<double> spacing(wall.points.size(), kNone);
  for (const TetMesh::Tet& tet : wall.tets) {
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t j = i + 1; j < 4; ++j) {
        const double length = glm::distance(wall.points[tet[i]], wall.points[tet[j]]);
        if (!(length > 0.0)) continue;
        spacing[tet[i]] = std::min(spacing[tet[i]], length);
        spacing[tet[j]] = std::min(spacing[tet[j]], length);
      }
    }
  }
  for (double& s : spacing)
    if (s == kNone) s = 1.0;
  return spacing;
}

FinishedMesh choose_wall(const SampledWall& wall, DelaunayCells cells) {
  FinishedMesh mesh;
  std::vector<std::uint8_t> kept(cells.tets.size(), 0);
  {
    const WallCells in(wall);
    for (std::size_t c = 0; c < kept.size(); ++c) {
      const TetMesh::Tet& tet = cells.tets[c];
      if (in.share_cell(tet)) {
        kept[c] = 1;
        ++mesh.shared;
        continue;
      }
      const Vec3 centroid =
          0.25 * (wall.points[tet[0]] + wall.points[tet[1]] + wall.points[tet[2]] + wall.points[tet[3]]);
      kept[c] = in.hold(centroid) ? 1 : 0;
      mesh.outside += kept[c] == 0 ? 1 : 0;
    }
  }
  mesh.flat = BorderPeel(wall.points, cells, kept).run();
  if (const std::uint64_t dropped = drop_islands(cells, kept); dropped > 0)
    mesh.note = std::to_string(dropped) + " tetrahedra that no face joins to the rest left out";
  std::size_t count = 0;
  for (std::size_t c = 0; c < kept.size(); ++c)
    if (kept[c] != 0) cells.tets[count++] = cells.tets[c];
  cells.tets.resize(count);
  mesh.tets = std::move(cells.tets);
  return mesh;
}

}  // namespace palpate
