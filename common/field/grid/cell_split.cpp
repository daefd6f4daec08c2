#include "common/field/grid/cell_split.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "common/base/error.h"
#include "common/base/index.h"
#include "common/field/data_set_check.h"
#include "common/field/grid/block_join.h"
#include "common/field/grid/cell_cone.h"
#include "common/field/grid/cell_faces.h"
#include "common/field/grid/tet_shape.h"

namespace palpate {
namespace {

using Ids = std::span<const std::uint32_t>;

class Splitter {
 public:
  Splitter(std::span<const DataSet> blocks, std::string file, const SplitJoins& joins)
      : blocks_(blocks), file_(std::move(file)), joined_(join_blocks(blocks, file_, joins.agree)) {
    if (!joins.first_of.empty()) {
      joined_.first_of = joins.first_of;
      joined_.merged = 0;
      for (std::size_t p = 0; p < joins.first_of.size(); ++p)
        joined_.merged += joins.first_of[p] != p ? 1 : 0;
    }
    mesh_.points = std::move(joined_.points);
    mesh_.merged_points = joined_.merged;
  }

  SplitMesh run() {
    choose_refinement();
    for (std::size_t b = 0; b < blocks_.size(); ++b) {
      block_ = b;
      if (structured(blocks_[b])) {
        split_structured();
      } else {
        split_unstructured(std::get<UnstructuredTopology>(blocks_[b].topology));
      }
      settle_handedness();
      first_cell_ += static_cast<std::uint32_t>(blocks_[b].cell_count());
    }
    if (mesh_.tets.empty()) refuse_flat();
    if (blocks_.size() > 1) drop_repeated();
    compact();
    return std::move(mesh_);
  }

 private:
  [[noreturn]] void refuse(const std::string& found, const std::string& expected) const {
    throw block_error(blocks_[block_], block_, blocks_.size(), file_, found, expected);
  }

  [[noreturn]] void refuse_flat() const {
    std::string found = "no three-dimensional cells";
    if (mesh_.dropped_cells > 0) {
      found += ": all " + std::to_string(mesh_.dropped_cells) + " cells are points, lines or surfaces";
    } else if (mesh_.blanked_cells > 0) {
      found += ": all " + std::to_string(mesh_.blanked_cells) + " cells have blanked or non-finite points";
    } else if (mesh_.unknown_cells > 0) {
      found += ": all " + std::to_string(mesh_.unknown_cells) + " cells are of types that cannot be split";
    }
    throw input_error(
        {.file = file_, .place = {}, .found = found, .expected = "a volume grid", .remedy = {}});
  }

  // --- cells --------------------------------------------------------------------------------------------

  /// Splits one cell of `type`; `ids` are joined points. Types are those of the VTK file format.
  void split_cell(std::uint8_t type, Ids ids) {
    const std::size_t first_tet = mesh_.tets.size();
    const CellFaces* shape = faces_of(type);
    if (type == kTetrahedron) {
      cone_.tetrahedron(ids[0], ids[1], ids[2], ids[3]);
    } else if (type == kHexahedron && all_differ(ids)) {
      std::array<std::uint32_t, 8> v{};
      std::copy_n(ids.begin(), 8, v.begin());
      cone_.hexahedron(v);
    } else if (shape != nullptr) {
      faces_.clear();
      for (const auto& face : shape->faces) {
        for (const std::uint8_t i : face) faces_.ids.push_back(ids[i]);
        faces_.ends.push_back(faces_.ids.size());
      }
      cone_.cell(faces_);
    }
    settle_cell(type, first_tet);
  }

  static bool all_differ(Ids ids) {
    for (std::size_t i = 0; i < 8; ++i) {
      for (std::size_t j = i + 1; j < 8; ++j) {
        if (ids[i] == ids[j]) return false;
      }
    }
    return true;
  }

  /// Notes the orientation of the tetrahedra that a cell became, and turns the cell if it is negative.
  void settle_cell(std::uint8_t type, std::size_t first_tet) {
    double volume = 0.0;
    bool positive = false;
    bool negative = false;
    for (std::size_t t = first_tet; t < mesh_.tets.size(); ++t) {
      const auto& v = mesh_.tets[t];
      const auto x = [&](std::size_t i) { return mesh_.points[v[i]] * joined_.unit; };
      const TetShape shape(x(0), x(1), x(2), x(3));
      volume += shape.volume6;
      if (shape.flat()) continue;
      positive = positive || shape.volume6 > 0.0;
      negative = negative || shape.volume6 < 0.0;
    }
    mesh_.source_cell.resize(mesh_.tets.size(), cell_);
    const bool turned = volume < 0.0;
    if (turned) {
      for (std::size_t t = first_tet; t < mesh_.tets.size(); ++t)
        std::swap(mesh_.tets[t][2], mesh_.tets[t][3]);
    }
    if (positive && negative) ++mesh_.folded_cells;
    if (positive || negative) ++(turned ? negative_ : positive_)[type];
  }

  /// Cells that turn against most of their type in the block are inverted.
  void settle_handedness() {
    bool left_handed = false;
    for (std::size_t type = 0; type < positive_.size(); ++type) {
      mesh_.inverted_cells += std::min(positive_[type], negative_[type]);
      left_handed = left_handed || (negative_[type] > positive_[type] && type == kHexahedron);
    }
    if (left_handed) ++mesh_.left_handed_blocks;
    positive_.fill(0);
    negative_.fill(0);
  }

  [[nodiscard]] bool usable(std::uint32_t input) const {
    const DataSet& block = blocks_[block_];
    return (block.visible.empty() || block.visible[input - joined_.first_point[block_]] != 0) &&
           is_finite(mesh_.points[input]);
  }

  /// Whether the data hides the cell in hand.
  [[nodiscard]] bool hidden() const {
    const DataSet& block = blocks_[block_];
    return !block.hidden_cells.empty() && block.hidden_cells[cell_ - first_cell_] != 0;
  }

  void split_structured() {
    const Index3 n = structured_points(blocks_[block_]);
    cell_ = first_cell_;
    if (n.x < 2 || n.y < 2 || n.z < 2) {
      mesh_.dropped_cells += blocks_[block_].cell_count();
      return;
    }
    const auto row = static_cast<std::uint32_t>(n.x);
    const std::uint32_t slice = row * static_cast<std::uint32_t>(n.y);
    for (int k = 0; k + 1 < n.z; ++k) {
      for (int j = 0; j + 1 < n.y; ++j) {
        std::uint32_t p = joined_.first_point[block_] + row * static_cast<std::uint32_t>(j) +
                          slice * static_cast<std::uint32_t>(k);
        for (int i = 0; i + 1 < n.x; ++i, ++p, ++cell_) {
          std::array<std::uint32_t, 8> v{p,         p + 1,         p + 1 + row,         p + row,
                                         p + slice, p + 1 + slice, p + 1 + row + slice, p + row + slice};
          if (hidden() || !std::ranges::all_of(v, [this](std::uint32_t id) { return usable(id); })) {
            ++mesh_.blanked_cells;
            continue;
          }
          for (std::uint32_t& id : v) id = joined_.first_of[id];
          split_cell(kHexahedron, v);
        }
      }
    }
  }

  /// Refines quadratic cells only where every volume cell is of that one type.
  void choose_refinement() {
    bool tets = true;
    bool hexahedra = true;
    for (const DataSet& block : blocks_) {
      const auto* cells = std::get_if<UnstructuredTopology>(&block.topology);
      if (cells == nullptr) {
        tets = hexahedra = false;
        continue;
      }
      for (const std::uint8_t type : cells->types) {
        if (!is_volume(type)) continue;
        tets = tets && type == kQuadraticTetrahedron;
        hexahedra = hexahedra && type == kTriquadraticHexahedron;
      }
    }
    refine_ = tets ? kQuadraticTetrahedron : hexahedra ? kTriquadraticHexahedron : std::uint8_t{0};
  }

  void split_unstructured(const UnstructuredTopology& cells) {
    std::vector<std::uint32_t> ids;
    for (std::size_t c = 0; c < cells.types.size(); ++c) {
      cell_ = first_cell_ + static_cast<std::uint32_t>(c);
      const std::uint8_t type = cells.types[c];
      if (is_flat(type)) {
        ++mesh_.dropped_cells;
        continue;
      }
      if (!is_volume(type)) {
        ++mesh_.unknown_cells;
        continue;
      }
      if (hidden()) {
        ++mesh_.blanked_cells;
        continue;
      }
      const auto begin = as_size(cells.offsets[c]);
      const auto end = as_size(cells.offsets[c + 1]);
      const std::span<const std::int64_t> stream(cells.connectivity.data() + begin, end - begin);
      if (type == kPolyhedron) {
        split_polyhedron(c, stream, cells.positions.tuples);
        continue;
      }
      const std::size_t wanted = point_count_of(type);
      const bool lagrange = corner_count_of(type) != 0 && wanted == 0;  // any number from the corners on
      if (lagrange ? stream.size() < corner_count_of(type) : stream.size() != wanted) {
        refuse("cell " + std::to_string(c) + " of type " + std::to_string(type) + " has " +
                   std::to_string(stream.size()) + " points",
               std::to_string(lagrange ? corner_count_of(type) : wanted));
      }
      ids.clear();
      bool complete = true;
      for (const std::int64_t id : stream) {
        const std::uint32_t input = checked(c, id, cells.positions.tuples);
        complete = complete && usable(input);
        ids.push_back(joined_.first_of[input]);
      }
      if (!complete) {
        ++mesh_.blanked_cells;
        continue;
      }
      split_known(type, ids);
    }
  }

  std::uint32_t checked(std::size_t cell, std::int64_t id, std::size_t points) const {
    if (id < 0 || as_size(id) >= points) {
      refuse("cell " + std::to_string(cell) + " names the point " + std::to_string(id),
             "a number from 0 to " + std::to_string(points == 0 ? 0 : points - 1));
    }
    return joined_.first_point[block_] + static_cast<std::uint32_t>(id);
  }

  void split_known(std::uint8_t type, const std::vector<std::uint32_t>& ids) {
    if (type == kVoxel) {
      const std::array<std::uint32_t, 8> v{ids[0], ids[1], ids[3], ids[2], ids[4], ids[5], ids[7], ids[6]};
      split_cell(kHexahedron, v);
      return;
    }
    if (type == refine_ && type == kQuadraticTetrahedron) {
      ++mesh_.refined_cells;
      for (const auto& part : quadratic_tetrahedron_parts(ids)) split_cell(kTetrahedron, part);
      return;
    }
    if (type == refine_ && type == kTriquadraticHexahedron) {
      ++mesh_.refined_cells;
      for (const auto& part : kTriquadraticParts) {
        std::array<std::uint32_t, 8> v{};
        std::ranges::transform(part, v.begin(), [&](std::uint8_t i) { return ids[i]; });
        split_cell(kHexahedron, v);
      }
      return;
    }
    const std::uint8_t linear = linear_type_of(type);
    if (linear != type) ++mesh_.corner_cells;
    split_cell(linear, Ids(ids).first(corner_count_of(linear)));
  }

  /// Four tetrahedra at the corners and four around the shortest diagonal of the octahedron between them.
  [[nodiscard]] std::array<std::array<std::uint32_t, 4>, 8> quadratic_tetrahedron_parts(Ids v) const {
    const auto square = [&](std::size_t i, std::size_t j) {
      const Vec3 d = (mesh_.points[v[i]] - mesh_.points[v[j]]) * joined_.unit;
      return glm::dot(d, d);
    };
    // The octahedron's diagonals and, for each, the other four vertices in turn around it.
    struct Diagonal {
      std::array<std::size_t, 2> ends;
      std::array<std::size_t, 4> ring;
    };
    static constexpr std::array<Diagonal, 3> kDiagonals{
        {{{4, 9}, {5, 6, 7, 8}}, {{5, 7}, {4, 8, 9, 6}}, {{6, 8}, {4, 5, 9, 7}}}};
    const Diagonal* shortest = kDiagonals.data();
    for (const Diagonal& d : kDiagonals) {
      if (square(d.ends[0], d.ends[1]) < square(shortest->ends[0], shortest->ends[1])) shortest = &d;
    }
    std::array<std::array<std::uint32_t, 4>, 8> parts{{{v[0], v[4], v[6], v[7]},
                                                       {v[4], v[1], v[5], v[8]},
                                                       {v[6], v[5], v[2], v[9]},
                                                       {v[7], v[8], v[9], v[3]}}};
    for (std::size_t i = 0; i < 4; ++i) {
      parts[4 + i] = {v[shortest->ends[0]], v[shortest->ends[1]], v[shortest->ring[i]],
                      v[shortest->ring[(i + 1) % 4]]};
    }
    return parts;
  }

  void split_polyhedron(std::size_t c, std::span<const std::int64_t> stream, std::size_t points) {
    const auto malformed = [&] {
      refuse("the face stream of polyhedron " + std::to_string(c) + " does not fit its length",
             "face count, then for each face its point count and points");
    };
    if (stream.empty() || stream[0] < 0) malformed();
    faces_.clear();
    bool complete = true;
    std::size_t at = 1;
    for (std::int64_t f = 0; f < stream[0]; ++f) {
      if (at >= stream.size() || stream[at] < 0 || as_size(stream[at]) > stream.size() - at - 1) {
        malformed();
      }
      const auto count = as_size(stream[at]);
      ++at;
      for (std::size_t i = 0; i < count; ++i) {
        const std::uint32_t input = checked(c, stream[at + i], points);
        complete = complete && usable(input);
        faces_.ids.push_back(joined_.first_of[input]);
      }
      faces_.ends.push_back(faces_.ids.size());
      at += count;
    }
    if (at != stream.size()) malformed();
    if (!complete) {
      ++mesh_.blanked_cells;
      return;
    }
    const std::size_t first_tet = mesh_.tets.size();
    if (!faces_.ids.empty()) {
      orient_faces(faces_);
      cone_.cell(faces_);
    }
    settle_cell(kPolyhedron, first_tet);
  }

  // --- the whole ----------------------------------------------------------------------------------------

  /// Ghost cells: blocks of a parallel run repeat cells of their neighbours.
  void drop_repeated() {
    struct Entry {
      std::array<std::uint32_t, 4> vertices;
      std::uint32_t tet;
    };
    std::vector<Entry> entries(mesh_.tets.size());
    for (std::size_t t = 0; t < entries.size(); ++t) {
      entries[t] = {mesh_.tets[t], static_cast<std::uint32_t>(t)};
      for (std::uint32_t& v : entries[t].vertices) v = joined_.place_of[v];
      std::ranges::sort(entries[t].vertices);
    }
    std::ranges::sort(entries, [](const Entry& a, const Entry& b) {
      return a.vertices != b.vertices ? a.vertices < b.vertices : a.tet < b.tet;
    });
    std::vector<std::uint8_t> repeated(mesh_.tets.size(), 0);
    for (std::size_t i = 1; i < entries.size(); ++i) {
      if (entries[i].vertices != entries[i - 1].vertices) continue;
      repeated[entries[i].tet] = 1;
      ++mesh_.repeated_tets;
    }
    if (mesh_.repeated_tets == 0) return;
    std::size_t kept = 0;
    for (std::size_t t = 0; t < mesh_.tets.size(); ++t) {
      if (repeated[t] != 0) continue;
      mesh_.tets[kept] = mesh_.tets[t];
      mesh_.source_cell[kept] = mesh_.source_cell[t];
      ++kept;
    }
    mesh_.tets.resize(kept);
    mesh_.source_cell.resize(kept);
  }

  /// Keeps the points that a tetrahedron uses, in their order.
  void compact() {
    std::vector<std::uint32_t> place(mesh_.points.size(), kNoPoint);
    for (const auto& tet : mesh_.tets) {
      for (const std::uint32_t v : tet) place[v] = 0;
    }
    std::uint32_t kept = 0;
    for (std::size_t p = 0; p < place.size(); ++p) {
      if (place[p] == kNoPoint) continue;
      mesh_.points[kept] = mesh_.points[p];
      place[p] = kept++;
    }
    mesh_.points.resize(kept);
    for (auto& tet : mesh_.tets) {
      for (std::uint32_t& v : tet) v = place[v];
    }
    mesh_.point_of_input.resize(place.size());
    for (std::size_t p = 0; p < place.size(); ++p) mesh_.point_of_input[p] = place[joined_.first_of[p]];
  }

  std::span<const DataSet> blocks_;
  std::string file_;
  JoinedPoints joined_;  ///< without the points themselves, which are in mesh_
  SplitMesh mesh_;
  CellCone cone_{joined_.odd, mesh_.tets};
  std::size_t block_ = 0;
  std::uint32_t first_cell_ = 0;  ///< of the block
  std::uint32_t cell_ = 0;
  std::uint8_t refine_ = 0;                  ///< type of the cells to be refined
  std::array<std::size_t, 256> positive_{};  ///< cells of the block by type and orientation
  std::array<std::size_t, 256> negative_{};
  FaceList faces_;  ///< scratch
};

}  // namespace

SplitMesh split_into_tetrahedra(std::span<const DataSet> blocks, const std::string& file,
                                const SplitJoins& joins) {
  if (blocks.empty()) {
    throw input_error(
        {.file = file, .place = {}, .found = "no blocks", .expected = "a volume grid", .remedy = {}});
  }
  return Splitter(blocks, file, joins).run();
}

}  // namespace palpate
