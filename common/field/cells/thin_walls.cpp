#include "common/field/cells/thin_walls.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <mutex>
#include <string>
#include <tuple>
#include <utility>

#include "common/base/disjoint_sets.h"
#include "common/base/index.h"
#include "common/base/parallel.h"
#include "common/field/grid/tet_seams.h"

namespace palpate {
namespace {

/// Groups of cells that share points are pieces of an exploded mesh where there are as many, or where they are as
/// small.
constexpr std::size_t kManyPieces = 9;
constexpr std::size_t kSmallPiece = 1000;
/// Of the speed at faces, by how much the velocities of both sides differ where they are the same, and how much of
/// it goes through the faces at least where the velocities are those of whole cells.
constexpr double kSame = 1e-5;
constexpr double kLittle = 1e-3;
/// And where they are no more than alike.
constexpr double kAlike = 0.5;
constexpr double kThrough = 0.1;
/// Of what goes through, by how much both sides may differ in it.
constexpr double kLeaks = 0.25;

std::array<std::uint32_t, 3> corners_of(const TetMesh& mesh, CellIndex cell, int face) {
  const TetMesh::Tet& v = mesh.cells()[as_size(cell)];
  const auto f = as_size(face);
  return {v[(f + 1) % 4], v[(f + 2) % 4], v[(f + 3) % 4]};
}

/// What lies behind the middle of a border face, or, where the two sides of a warped face part there, near a corner.
CellIndex behind_face(const TetMesh& mesh, CellIndex cell, int face, Vec3& x) {
  constexpr double kNear = 0.9;
  for (int sample = 0; sample < 4; ++sample) {
    Vec4 b(sample == 0 ? 1.0 / 3.0 : 0.5 * (1.0 - kNear));
    b[face] = 0.0;
    if (sample > 0) b[(face + sample) % 4] = kNear;
    x = mesh.position(cell, b);
    const CellIndex found = cell_behind(mesh, cell, face, x).cell;
    if (found != kNoCell) return found;
  }
  return kNoCell;
}

/// A border face and the source cell right behind it, corner on corner.
struct DoubledFace {
  std::uint32_t cell = 0, behind = 0;  ///< source cells
  std::array<std::uint32_t, 3> corners{}, twins{};
  double area = 0.0;
  Vec3 outward{0.0};
};

/// What flows at faces that belong together.
struct Flow {
  double speed = 0.0, through = 0.0, apart = 0.0;  ///< integrals over the faces
  double leaks = 0.0;                              ///< of what leaves one side, less what enters the other
  bool rim = false;
  bool exact = true;  ///< points of both sides have the very same coordinates
};

class WallSearch {
 public:
  WallSearch(const SplitCells& cells, const VelocityBeside& velocity)
      : cells_(cells), mesh_(cells.mesh), velocity_(velocity), pieces_(source_cells()) {
    sort_by_source();
    unite_cells();
  }

  [[nodiscard]] std::vector<DoubledFace> doubled_faces(int threads) const {
    std::vector<DoubledFace> out;
    std::mutex mutex;
    parallel_for(mesh_.cells().size(), threads, [&](std::size_t first, std::size_t last) {
      std::vector<DoubledFace> here;
      for (std::size_t c = first; c < last; ++c) {
        if (mesh_.zero_volume(static_cast<CellIndex>(c))) continue;
        for (int face = 0; face < 4; ++face) {
          DoubledFace found;
          if (mesh_.neighbors()[c][as_size(face)] == kNoCell &&
              doubled(static_cast<CellIndex>(c), face, found))
            here.push_back(found);
        }
      }
      const std::lock_guard lock(mutex);
      out.insert(out.end(), here.begin(), here.end());
    });
    std::ranges::sort(out, [](const DoubledFace& a, const DoubledFace& b) {
      return std::tie(a.cell, a.behind, a.corners) < std::tie(b.cell, b.behind, b.corners);
    });
    return out;
  }

  /// Cells of the face's block have points of their own, each or in small groups.
  [[nodiscard]] bool exploded(const DoubledFace& face) const {
    const std::size_t block = block_of(face.cell);
    const std::size_t pieces = piece_count_[block], count = cell_count_[block];
    return pieces == count || (pieces >= kManyPieces && count <= kSmallPiece * pieces);
  }
  [[nodiscard]] std::uint32_t piece(std::uint32_t cell) { return pieces_.find(cell); }

  void add(Flow& flow, const DoubledFace& face) const {
    Vec3 here{0.0}, there{0.0};
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3 u = velocity_(face.cell, face.corners[i]), v = velocity_(face.behind, face.twins[i]);
      flow.rim = flow.rim || face.corners[i] == face.twins[i];
      flow.exact = flow.exact && mesh_.points()[face.corners[i]] == mesh_.points()[face.twins[i]];
      if (!is_finite(u) || !is_finite(v)) continue;
      here += u / 3.0;
      there += v / 3.0;
    }
    const double out = glm::dot(here, face.outward), on = glm::dot(there, face.outward);
    flow.speed += face.area * std::max(glm::length(here), glm::length(there));
    flow.apart += face.area * glm::distance(here, there);
    flow.leaks += face.area * std::abs(out - on);
    if (out * on > 0.0) flow.through += face.area * std::min(std::abs(out), std::abs(on));
  }

 private:
  [[nodiscard]] std::size_t source_cells() const {
    return cells_.source_cell.empty() ? 0 : std::size_t{std::ranges::max(cells_.source_cell)} + 1;
  }
  [[nodiscard]] std::size_t block_of(std::uint32_t cell) const {
    return as_size(std::ranges::upper_bound(cells_.first_cell, cell) - cells_.first_cell.begin()) - 1;
  }
  [[nodiscard]] std::span<const std::uint32_t> tets_of(std::uint32_t cell) const {
    return std::span(tets_).subspan(begin_[cell], begin_[cell + 1] - begin_[cell]);
  }

  void sort_by_source() {
    begin_.assign(source_cells() + 1, 0);
    for (const std::uint32_t cell : cells_.source_cell) ++begin_[cell + 1];
    for (std::size_t c = 0; c + 1 < begin_.size(); ++c) begin_[c + 1] += begin_[c];
    tets_.resize(cells_.source_cell.size());
    std::vector<std::size_t> next(begin_.begin(), begin_.end() - 1);
    for (std::size_t t = 0; t < tets_.size(); ++t)
      tets_[next[cells_.source_cell[t]]++] = static_cast<std::uint32_t>(t);
  }

  /// Cells of one block that share a point are of one piece.
  void unite_cells() {
    const std::size_t blocks = cells_.first_cell.size();
    piece_count_.assign(blocks, 0);
    cell_count_.assign(blocks, 0);
    std::vector<std::uint32_t> user(mesh_.points().size(), 0);
    std::vector<std::uint32_t> user_block(user.size(), static_cast<std::uint32_t>(blocks));
    const auto cells = static_cast<std::uint32_t>(source_cells());
    for (std::uint32_t cell = 0; cell < cells; ++cell) {
      if (tets_of(cell).empty()) continue;
      const auto block = static_cast<std::uint32_t>(block_of(cell));
      ++cell_count_[block];
      for (const std::uint32_t t : tets_of(cell)) {
        for (const std::uint32_t v : mesh_.cells()[t]) {
          if (std::exchange(user_block[v], block) == block) pieces_.unite(user[v], cell);
          user[v] = cell;
        }
      }
    }
    for (std::uint32_t cell = 0; cell < cells; ++cell) {
      if (!tets_of(cell).empty() && pieces_.find(cell) == cell) ++piece_count_[block_of(cell)];
    }
  }

  /// The point of a source cell at the place of `point`, best itself.
  [[nodiscard]] bool find_twin(std::uint32_t cell, std::uint32_t point, std::uint32_t& twin) const {
    bool found = false;
    for (const std::uint32_t t : tets_of(cell)) {
      for (const std::uint32_t v : mesh_.cells()[t]) {
        if (cells_.place[v] != cells_.place[point] || (found && v != point)) continue;
        twin = v;
        found = true;
      }
    }
    return found;
  }

  [[nodiscard]] bool doubled(CellIndex cell, int face, DoubledFace& out) const {
    Vec3 x;
    const CellIndex behind = behind_face(mesh_, cell, face, x);
    if (behind == kNoCell) return false;
    out.cell = cells_.source_cell[as_size(cell)];
    out.behind = cells_.source_cell[as_size(behind)];
    if (out.cell == out.behind || block_of(out.cell) != block_of(out.behind)) return false;
    // The border face of the other cell that is nearest.
    const Vec4 there = mesh_.barycentric(behind, x);
    int facing = -1;
    for (int i = 0; i < 4; ++i) {
      if (mesh_.neighbors()[as_size(behind)][as_size(i)] == kNoCell &&
          (facing < 0 || there[i] < there[facing]))
        facing = i;
    }
    if (facing < 0) return false;
    std::uint32_t twin = 0;
    for (const std::uint32_t v : corners_of(mesh_, behind, facing)) {
      if (!find_twin(out.cell, v, twin)) return false;
    }
    out.corners = corners_of(mesh_, cell, face);
    for (std::size_t i = 0; i < 3; ++i) {
      if (!find_twin(out.behind, out.corners[i], out.twins[i])) return false;
    }
    // Faces with other diagonals differ though they share all their points.
    if (out.corners == out.twins) return false;
    const std::span<const Vec3> points = mesh_.points();
    out.area = 0.5 * glm::length(glm::cross(points[out.corners[1]] - points[out.corners[0]],
                                            points[out.corners[2]] - points[out.corners[0]]));
    out.outward = face_normal(mesh_, cell, face).outward;
    return true;
  }

  const SplitCells& cells_;
  const TetMesh& mesh_;
  const VelocityBeside& velocity_;
  DisjointSets pieces_;
  std::vector<std::size_t> begin_;   ///< of each source cell in tets_
  std::vector<std::uint32_t> tets_;  ///< of the mesh, by source cell
  std::vector<std::size_t> piece_count_, cell_count_;
};

/// Flow goes through faces, alike on both sides, or along them with one velocity.
bool flows(const Flow& flow, Association of) {
  if (!(flow.speed > 0.0)) return false;
  const double least = of == Association::kCell ? kLittle * flow.speed : 0.0;
  if (flow.apart <= kSame * flow.speed && flow.through >= least) return true;
  if (flow.apart > kAlike * flow.speed) return false;
  // Or little of it, but what leaves one side comes in on the other one.
  return flow.through >= kThrough * flow.speed ||
         (flow.through >= kLittle * flow.speed && flow.leaks <= kLeaks * flow.through);
}

}  // namespace

ThinWalls::ThinWalls(const SplitCells& cells, const VelocityBeside& velocity, Association of, int threads) {
  WallSearch search(cells, velocity);
  const std::vector<DoubledFace> faces = search.doubled_faces(threads);
  if (faces.empty()) return;

  // Faces within a piece belong together where they meet, those of two pieces all do.
  DisjointSets meeting(cells.place.size());
  for (const DoubledFace& face : faces) {
    if (search.piece(face.cell) != search.piece(face.behind)) continue;
    for (std::size_t i = 1; i < 3; ++i)
      meeting.unite(cells.place[face.corners[0]], cells.place[face.corners[i]]);
  }
  const auto key_of = [&](const DoubledFace& face) {
    const std::uint32_t a = search.piece(face.cell), b = search.piece(face.behind);
    return std::pair(pair_key(a, b), a == b ? meeting.find(cells.place[face.corners[0]]) : 0U);
  };
  std::map<std::pair<std::uint64_t, std::uint32_t>, Flow> flow;
  const auto loose = [&](const DoubledFace& face) {
    return search.piece(face.cell) != search.piece(face.behind) && search.exploded(face);
  };
  for (const DoubledFace& face : faces) {
    if (!loose(face)) search.add(flow[key_of(face)], face);
  }
  for (const DoubledFace& face : faces) {
    if (loose(face)) {
      ++own_points_;
      continue;
    }
    const Flow& here = flow[key_of(face)];
    const bool through = flows(here, of);
    if (through && !(here.rim && here.exact)) {
      ++seam_faces_;
      continue;
    }
    ++wall_faces_;
    if (through) ++flowed_through_;
    parted_.push_back(pair_key(face.cell, face.behind));
    if (points_.empty()) points_.assign(cells.mesh.points().size(), 0);
    for (std::size_t i = 0; i < 3; ++i) {
      if (face.corners[i] != face.twins[i]) points_[face.corners[i]] = points_[face.twins[i]] = 1;
    }
  }
  std::ranges::sort(parted_);
  parted_.erase(std::unique(parted_.begin(), parted_.end()), parted_.end());
}

void ThinWalls::close_faces(TetMesh& mesh, std::span<const std::uint32_t> source_cell) const {
  if (parted_.empty()) return;
  std::vector<std::uint8_t> beside(std::size_t{std::ranges::max(source_cell)} + 1, 0);
  for (const std::uint64_t pair : parted_) beside[pair >> 32U] = beside[pair & 0xFFFFFFFFU] = 1;
  struct Face {
    CellIndex cell;
    int face;
  };
  // First all that are walls: what is closed hides what is behind.
  std::vector<Face> walls;
  for (std::size_t c = 0; c < mesh.cells().size(); ++c) {
    const auto cell = static_cast<CellIndex>(c);
    if (beside[source_cell[c]] == 0 || mesh.zero_volume(cell)) continue;
    for (int face = 0; face < 4; ++face) {
      // Three corners of the rim: the tetrahedra of both sides share the face though the cells do not.
      CellIndex behind = mesh.neighbors()[c][as_size(face)];
      Vec3 x;
      if (behind == kNoCell) behind = behind_face(mesh, cell, face, x);
      if (behind != kNoCell &&
          std::ranges::binary_search(parted_, pair_key(source_cell[c], source_cell[as_size(behind)])))
        walls.push_back({cell, face});
    }
  }
  for (const Face& wall : walls) mesh.close(wall.cell, wall.face);
}

void ThinWalls::note(FieldNotes& notes) const {
  const auto faces = [](std::size_t count) {
    return std::to_string(count) + (count == 1 ? " border face" : " border faces");
  };
  if (wall_faces_ > 0) {
    notes.lines.push_back(
        faces(wall_faces_) +
        " back to back, with points of their own in a mesh whose cells share theirs: thin walls "
        "(baffles), lines end there, each side keeps its values");
  }
  if (flowed_through_ > 0) {
    notes.lines.push_back(
        faces(flowed_through_) +
        " of thin walls have the same flow on both sides: if they are no walls, join the points "
        "of the mesh before it is written");
  }
  if (seam_faces_ > 0) {
    notes.lines.push_back(
        faces(seam_faces_) +
        " back to back, with points of their own and the same flow on both sides: seams, not "
        "thin walls, lines go on there");
  }
  if (own_points_ > 0) {
    notes.lines.emplace_back(
        "cells with points of their own: a thin wall (baffle) among them could not be distinguished from their other faces");
  }
}

}  // namespace palpate
