#include "common/field/grid/cell_split.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "common/base/error.h"
#include "common/field/data_set_check.h"
#include "common/field/grid/cell_faces.h"
#include "common/field/grid/point_merge.h"
#include "common/field/grid/tet_shape.h"
#include "common/math/power_of_two.h"

namespace palpate {
namespace {

using Ids = std::span<const std::uint32_t>;

bool structured(const DataSet& block) {
  return !std::holds_alternative<UnstructuredTopology>(block.topology);
}

class Splitter {
 public:
  Splitter(std::span<const DataSet> blocks, std::string file) : blocks_(blocks), file_(std::move(file)) {}

  SplitMesh run() {
    gather_points();
    merge();
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

  // --- points -------------------------------------------------------------------------------------------

  void gather_points() {
    std::size_t points = 0;
    std::size_t cells = 0;
    for (block_ = 0; block_ < blocks_.size(); ++block_) {
      first_point_.push_back(static_cast<std::uint32_t>(points));
      check_block(blocks_[block_], block_, blocks_.size(), file_);
      points += blocks_[block_].point_count();
      cells += blocks_[block_].cell_count();
      if (points >= kNoPoint || cells >= kNoPoint) refuse("more than 2^32 - 2 points or cells", "fewer");
    }
    block_ = 0;
    mesh_.points.reserve(points);
    odd_.reserve(points);
    for (const DataSet& block : blocks_) append_points(block);

    Box bounds;
    for (const Vec3& x : mesh_.points) {
      if (is_finite(x)) bounds.include(x);
    }
    const Vec3 size = bounds.size();
    unit_ = power_of_two(-binary_exponent(std::max({size.x, size.y, size.z})));
  }

  void append_points(const DataSet& block) {
    const auto append_array = [this](const DataArray& positions) {
      for (std::size_t i = 0; i < positions.tuples; ++i) {
        mesh_.points.emplace_back(positions.at(i, 0), positions.at(i, 1), positions.at(i, 2));
      }
    };
    if (const auto* cells = std::get_if<UnstructuredTopology>(&block.topology)) {
      append_array(cells->positions);
      odd_.insert(odd_.end(), cells->positions.tuples, 0);
      return;
    }
    const Index3 n = structured_points(block);
    const auto* uniform = std::get_if<UniformTopology>(&block.topology);
    const auto* lines = std::get_if<RectilinearTopology>(&block.topology);
    if (const auto* grid = std::get_if<StructuredTopology>(&block.topology)) append_array(grid->positions);
    for (int k = 0; k < n.z; ++k) {
      for (int j = 0; j < n.y; ++j) {
        for (int i = 0; i < n.x; ++i) {
          odd_.push_back(static_cast<std::uint8_t>((i + j + k) & 1));
          if (uniform != nullptr) {
            mesh_.points.push_back(uniform->origin + uniform->axes * Vec3(i, j, k));
          } else if (lines != nullptr) {
            mesh_.points.emplace_back(lines->coordinates[0][static_cast<std::size_t>(i)],
                                      lines->coordinates[1][static_cast<std::size_t>(j)],
                                      lines->coordinates[2][static_cast<std::size_t>(k)]);
          }
        }
      }
    }
  }

  // --- joining blocks -----------------------------------------------------------------------------------

  void merge() {
    std::vector<MergeCandidate> candidates;
    for (std::size_t b = 0; b < blocks_.size(); ++b) {
      const DataSet& block = blocks_[b];
      if (structured(block)) {
        // Uniform and rectilinear blocks have no seams of their own.
        const bool seams = std::holds_alternative<StructuredTopology>(block.topology);
        if (seams || blocks_.size() > 1) add_shell(b, seams, candidates);
      } else if (blocks_.size() > 1) {
        add_points(b, std::get<UnstructuredTopology>(block.topology), candidates);
      }
    }
    first_of_ = merge_points(mesh_.points, candidates, kMergeDistance);
    for (std::size_t p = 0; p < first_of_.size(); ++p) mesh_.merged_points += first_of_[p] != p ? 1 : 0;
  }

  void include_edge(double& spacing, std::size_t p, std::size_t q) const {
    const double length = glm::length((mesh_.points[p] - mesh_.points[q]) * unit_) / unit_;
    if (length > 0.0 && std::isfinite(length)) spacing = spacing == 0.0 ? length : std::min(spacing, length);
  }

  /// The points on the outer faces of a structured block.
  void add_shell(std::size_t b, bool seams, std::vector<MergeCandidate>& candidates) const {
    const Index3 n = structured_points(blocks_[b]);
    const std::array<std::size_t, 3> step{1, static_cast<std::size_t>(n.x),
                                          static_cast<std::size_t>(n.x) * static_cast<std::size_t>(n.y)};
    for (int k = 0; k < n.z; ++k) {
      for (int j = 0; j < n.y; ++j) {
        const bool shell_row = k == 0 || k == n.z - 1 || j == 0 || j == n.y - 1;
        const int stride = shell_row ? 1 : std::max(1, n.x - 1);
        for (int i = 0; i < n.x; i += stride) {
          const Index3 at{i, j, k};
          const std::size_t p = first_point_[b] + static_cast<std::size_t>(i) +
                                step[1] * static_cast<std::size_t>(j) + step[2] * static_cast<std::size_t>(k);
          if (!is_finite(mesh_.points[p])) continue;
          double spacing = 0.0;
          for (std::size_t axis = 0; axis < 3; ++axis) {
            if (at[static_cast<int>(axis)] > 0) include_edge(spacing, p, p - step[axis]);
            if (at[static_cast<int>(axis)] + 1 < n[static_cast<int>(axis)]) {
              include_edge(spacing, p, p + step[axis]);
            }
          }
          candidates.push_back(
              {static_cast<std::uint32_t>(p), spacing, static_cast<std::uint32_t>(b), seams});
        }
      }
    }
  }

  /// All points that the volume cells of an unstructured block name.
  void add_points(std::size_t b, const UnstructuredTopology& cells,
                  std::vector<MergeCandidate>& candidates) const {
    const std::size_t count = cells.positions.tuples;
    std::vector<double> spacing(count, 0.0);
    std::vector<std::uint8_t> used(count, 0);
    const auto known = [&](std::int64_t id) { return id >= 0 && static_cast<std::size_t>(id) < count; };
    for (std::size_t c = 0; c < cells.types.size(); ++c) {
      if (!is_volume(cells.types[c]) || cells.types[c] == kPolyhedron) continue;
      const auto begin = static_cast<std::size_t>(cells.offsets[c]);
      const auto end = static_cast<std::size_t>(cells.offsets[c + 1]);
      for (std::size_t i = begin; i < end; ++i) {
        if (!known(cells.connectivity[i])) continue;  // refused when the cell is split
        const auto p = static_cast<std::size_t>(cells.connectivity[i]);
        used[p] = 1;
        const std::int64_t other = cells.connectivity[i + 1 < end ? i + 1 : begin];
        if (!known(other)) continue;
        const auto q = static_cast<std::size_t>(other);
        include_edge(spacing[p], first_point_[b] + p, first_point_[b] + q);
        include_edge(spacing[q], first_point_[b] + p, first_point_[b] + q);
      }
    }
    for_each_polyhedron_edge(cells, [&](std::size_t p, std::size_t q) {
      used[p] = 1;
      include_edge(spacing[p], first_point_[b] + p, first_point_[b] + q);
      include_edge(spacing[q], first_point_[b] + p, first_point_[b] + q);
    });
    for (std::size_t p = 0; p < count; ++p) {
      if (used[p] == 0 || !is_finite(mesh_.points[first_point_[b] + p])) continue;
      candidates.push_back({first_point_[b] + static_cast<std::uint32_t>(p), spacing[p],
                            static_cast<std::uint32_t>(b), false});
    }
  }

  // --- cells --------------------------------------------------------------------------------------------

  /// Order of vertices that both cells beside a face see: even points of structured blocks first.
  [[nodiscard]] std::uint64_t key(std::uint32_t id) const {
    return (static_cast<std::uint64_t>(odd_[id]) << 32U) | id;
  }

  [[nodiscard]] std::size_t least(Ids ids) const {
    std::size_t best = 0;
    for (std::size_t i = 1; i < ids.size(); ++i) {
      if (key(ids[i]) < key(ids[best])) best = i;
    }
    return best;
  }

  void emit(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    if (a == b || a == c || a == d || b == c || b == d || c == d) return;
    mesh_.tets.push_back({a, b, c, d});
  }

  /// Cones the cell with these outward faces from its vertex of the smallest key.
  void cone(const FaceList& faces) {
    std::uint32_t apex = faces.ids.front();
    for (const std::uint32_t id : faces.ids) {
      if (key(id) < key(apex)) apex = id;
    }
    std::size_t begin = 0;
    for (const std::size_t end : faces.ends) {
      // A face that collapsed to an edge, or touches itself, covers nothing.
      face_.clear();
      bool repeats = false;
      for (std::size_t i = begin; i < end; ++i) {
        if (!face_.empty() && face_.back() == faces.ids[i]) continue;
        repeats = repeats || (std::ranges::find(face_, faces.ids[i]) != face_.end() &&
                              !(i + 1 == end && face_.front() == faces.ids[i]));
        face_.push_back(faces.ids[i]);
      }
      while (face_.size() > 1 && face_.front() == face_.back()) face_.pop_back();
      begin = end;
      if (repeats || face_.size() < 3 || std::ranges::find(face_, apex) != face_.end()) continue;
      const std::size_t n = face_.size();
      const std::size_t root = least(face_);
      for (std::size_t i = 1; i + 1 < n; ++i) {
        emit(apex, face_[root], face_[(root + i) % n], face_[(root + i + 1) % n]);
      }
    }
  }

  /// A hexahedron whose eight vertices differ. Where no diagonal of the faces away from the smallest vertex
  /// meets the vertex opposite to it, five tetrahedra do; else the cone's six.
  void split_hexahedron(const std::array<std::uint32_t, 8>& v) {
    static constexpr std::array<std::size_t, 8> kOpposite{6, 7, 4, 5, 2, 3, 0, 1};
    const std::size_t apex = least(v);
    const std::size_t far = kOpposite[apex];
    struct Corner {
      std::uint32_t before, across, after;  ///< of a face around the far vertex
    };
    std::array<Corner, 3> corners{};
    std::size_t count = 0;
    bool far_on_diagonal = false;
    for (const auto& face : kHexahedronFaces) {
      const auto at = std::ranges::find(face, far);
      if (at == face.end()) continue;
      const auto i = static_cast<std::size_t>(at - face.begin());
      const Corner corner{v[face[(i + 3) % 4]], v[face[(i + 2) % 4]], v[face[(i + 1) % 4]]};
      const std::uint64_t least_key =
          std::min({key(corner.before), key(corner.across), key(corner.after), key(v[far])});
      far_on_diagonal = far_on_diagonal || least_key == key(v[far]) || least_key == key(corner.across);
      corners[count++] = corner;
    }
    if (far_on_diagonal) {
      faces_.clear();
      for (const auto& face : kHexahedronFaces) {
        for (const std::size_t i : face) faces_.ids.push_back(v[i]);
        faces_.ends.push_back(faces_.ids.size());
      }
      cone(faces_);
      return;
    }
    // The cap at the far vertex is cut off by the triangle of its three neighbours.
    for (const Corner& c : corners) emit(v[apex], c.after, c.across, c.before);
    const std::uint32_t x = corners[0].after;
    const std::uint32_t y = corners[0].before;
    const std::uint32_t z =
        corners[1].before == x || corners[1].before == y ? corners[1].after : corners[1].before;
    emit(v[apex], x, y, z);
    emit(v[far], x, z, y);
  }

  /// Splits one cell of `type`; `ids` are joined points. Types are those of the VTK file format.
  void split_cell(std::uint8_t type, Ids ids) {
    const std::size_t first_tet = mesh_.tets.size();
    const CellFaces* shape = faces_of(type);
    if (type == kTetrahedron) {
      emit(ids[0], ids[1], ids[2], ids[3]);
    } else if (type == kHexahedron && all_differ(ids)) {
      std::array<std::uint32_t, 8> v{};
      std::copy_n(ids.begin(), 8, v.begin());
      split_hexahedron(v);
    } else if (shape != nullptr) {
      faces_.clear();
      for (const auto& face : shape->faces) {
        for (const std::uint8_t i : face) faces_.ids.push_back(ids[i]);
        faces_.ends.push_back(faces_.ids.size());
      }
      cone(faces_);
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
      const auto x = [&](std::size_t i) { return mesh_.points[v[i]] * unit_; };
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
    return (block.visible.empty() || block.visible[input - first_point_[block_]] != 0) &&
           is_finite(mesh_.points[input]);
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
        std::uint32_t p = first_point_[block_] + row * static_cast<std::uint32_t>(j) +
                          slice * static_cast<std::uint32_t>(k);
        for (int i = 0; i + 1 < n.x; ++i, ++p, ++cell_) {
          std::array<std::uint32_t, 8> v{p,         p + 1,         p + 1 + row,         p + row,
                                         p + slice, p + 1 + slice, p + 1 + row + slice, p + row + slice};
          if (!std::ranges::all_of(v, [this](std::uint32_t id) { return usable(id); })) {
            ++mesh_.blanked_cells;
            continue;
          }
          for (std::uint32_t& id : v) id = first_of_[id];
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
      const auto begin = static_cast<std::size_t>(cells.offsets[c]);
      const auto end = static_cast<std::size_t>(cells.offsets[c + 1]);
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
        ids.push_back(first_of_[input]);
      }
      if (!complete) {
        ++mesh_.blanked_cells;
        continue;
      }
      split_known(type, ids);
    }
  }

  std::uint32_t checked(std::size_t cell, std::int64_t id, std::size_t points) const {
    if (id < 0 || static_cast<std::size_t>(id) >= points) {
      refuse("cell " + std::to_string(cell) + " names the point " + std::to_string(id),
             "a number from 0 to " + std::to_string(points == 0 ? 0 : points - 1));
    }
    return first_point_[block_] + static_cast<std::uint32_t>(id);
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
      const Vec3 d = (mesh_.points[v[i]] - mesh_.points[v[j]]) * unit_;
      return glm::dot(d, d);
    };
    // The octahedron's diagonals and, for each, the other four vertices in turn around it.
    struct Diagonal {
      std::array<std::size_t, 2> ends;
      std::array<std::size_t, 4> ring;
    };
    static constexpr std::array<Diagonal, 3> kDiagonals{
        {{{4, 9}, {5, 6, 7, 8}}, {{5, 7}, {4, 8, 9, 6}}, {{6, 8}, {4, 7, 9, 5}}}};
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
      if (at >= stream.size() || stream[at] < 0 ||
          static_cast<std::size_t>(stream[at]) > stream.size() - at - 1) {
        malformed();
      }
      const auto count = static_cast<std::size_t>(stream[at]);
      ++at;
      for (std::size_t i = 0; i < count; ++i) {
        const std::uint32_t input = checked(c, stream[at + i], points);
        complete = complete && usable(input);
        faces_.ids.push_back(first_of_[input]);
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
      cone(faces_);
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
    for (std::size_t p = 0; p < place.size(); ++p) mesh_.point_of_input[p] = place[first_of_[p]];
  }

  std::span<const DataSet> blocks_;
  std::string file_;
  SplitMesh mesh_;
  std::vector<std::uint32_t> first_point_;  ///< of each block
  std::vector<std::uint8_t> odd_;           ///< i + j + k of structured points is odd
  std::vector<std::uint32_t> first_of_;     ///< joined points
  double unit_ = 1.0;                       ///< power of two that makes lengths about one
  std::size_t block_ = 0;
  std::uint32_t first_cell_ = 0;  ///< of the block
  std::uint32_t cell_ = 0;
  std::uint8_t refine_ = 0;                  ///< type of the cells to be refined
  std::array<std::size_t, 256> positive_{};  ///< cells of the block by type and orientation
  std::array<std::size_t, 256> negative_{};
  FaceList faces_;                   ///< scratch
  std::vector<std::uint32_t> face_;  ///< scratch
};

}  // namespace

SplitMesh split_into_tetrahedra(std::span<const DataSet> blocks, const std::string& file) {
  if (blocks.empty()) {
    throw input_error(
        {.file = file, .place = {}, .found = "no blocks", .expected = "a volume grid", .remedy = {}});
  }
  return Splitter(blocks, file).run();
}

}  // namespace palpate
