#include "common/trace/isosurface/isosurface_mesh.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <type_traits>
#include <unordered_map>
#include <utility>
#include <variant>

#include "common/base/error.h"
#include "common/base/index.h"
#include "common/field/grid/box_grid.h"
#include "common/field/grid/scalar_cell.h"
#include "common/field/grid/tet_mesh.h"
#include "common/ode/root.h"

namespace palpate {
namespace {

constexpr double kRoot = 0x1p-48;  // of an edge
constexpr std::uint32_t kNone = 0xFFFF'FFFFU;

/// Thrown and caught here: the surface takes more triangles than may be made.
struct TooMany {};

/// Where on the edge a to b, from 0 to 1, `f` is zero; f(0) = fa and f(1) = fb lie on either side of it.
template <class Function>
double root_on_edge(const Function& f, double fa, double fb) {
  // Zero lies above: it is the root itself.
  if (fa == 0.0) return 0.0;
  if (fb == 0.0) return 1.0;
  return bracketed_root(f, 0.0, 1.0, fa, fb, kRoot);
}

/// Triangles in frame L, and what their normals add up to.
class Triangles {
 public:
  explicit Triangles(std::size_t most) : most_(most) {}

  std::uint32_t add_point(const Vec3& x) {
    points_.push_back(x);
    normals_.emplace_back(0.0);
    return static_cast<std::uint32_t>(points_.size() - 1);
  }

  /// Cuts a tetrahedron of positive volume, or mirrored of negative one.
  /// @param edge (i, j) -> the vertex on the edge between those corners.
  /// @param gradient x -> that of s there, of the cell; perhaps zero.
  template <class Edge, class Gradient>
  void cut(const std::array<bool, 4>& above, bool mirrored, const Edge& edge, const Gradient& gradient) {
    const int high = above[0] + above[1] + above[2] + above[3];
    if (high == 0 || high == 4) return;
    if (high != 2) {
      // The others of each corner, in an even permutation: the triangle faces away from it.
      static constexpr std::array<std::array<int, 3>, 4> kOthers{
          {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};
      int alone = 0;
      while (above[as_size(alone)] != (high == 1)) ++alone;
      const auto& [b, c, d] = kOthers[as_size(alone)];
      add({edge(alone, b), edge(alone, c), edge(alone, d)}, mirrored != (high == 1), gradient);
      return;
    }
    // Even permutations with the two lower corners first: the quadrilateral faces the upper ones.
    static constexpr std::array<std::array<int, 4>, 6> kPairs{
        {{0, 1, 2, 3}, {0, 2, 3, 1}, {0, 3, 1, 2}, {1, 2, 0, 3}, {1, 3, 2, 0}, {2, 3, 0, 1}}};
    for (const auto& [a, b, c, d] : kPairs) {
      if (above[as_size(a)] || above[as_size(b)]) continue;
      const std::uint32_t ac = edge(a, c), ad = edge(a, d), bd = edge(b, d), bc = edge(b, c);
      add({ac, ad, bd}, mirrored, gradient);
      add({ac, bd, bc}, mirrored, gradient);
    }
  }

  [[nodiscard]] IsosurfaceMesh finish(double level, const LocalFrame& frame) && {
    IsosurfaceMesh mesh{.level = level, .points = std::move(points_), .triangles = std::move(triangles_)};
    mesh.normals.reserve(normals_.size());
    for (const Vec3& sum : normals_) {
      const Vec3 unit = unit_or_zero(sum);
      mesh.normals.emplace_back(frame.rotated ? frame.rotation * unit : unit);
    }
    for (Vec3& x : mesh.points) x = frame.data_from_local(x);
    if (frame.rotated && glm::determinant(frame.rotation) < 0.0) {  // a mirror turns triangles over
      for (auto& [a, b, c] : mesh.triangles) std::swap(b, c);
    }
    return mesh;
  }

 private:
  template <class Gradient>
  void add(std::array<std::uint32_t, 3> corners, bool turned, const Gradient& gradient) {
    if (triangles_.size() >= most_) throw TooMany{};
    if (turned) std::swap(corners[1], corners[2]);
    triangles_.push_back(corners);
    const Vec3 a = points_[corners[0]], b = points_[corners[1]], c = points_[corners[2]];
    const Vec3 face = glm::cross(b - a, c - a);
    const double area = glm::length(face);
    if (!(area > 0.0)) return;
    for (const std::uint32_t corner : corners) {
      const Vec3 slope = gradient(points_[corner]);
      const double size = glm::length(slope);
      normals_[corner] += size > 0.0 && std::isfinite(size) ? slope * (area / size) : face;
    }
  }

  std::size_t most_;
  std::vector<Vec3> points_, normals_;
  std::vector<std::array<std::uint32_t, 3>> triangles_;
};

/// Marches through a grid of boxes slice by slice along z, two slices of vertices at hand.
class BoxMarch {
 public:
  /// @param axes the grid along whose axes all coordinates are.
  /// @param exact y -> s - s_0 of the field, where the grid is only a sampling of it; null: the grid is the
  /// field.
  BoxMarch(const BoxGrid& grid, const BoxGrid& axes, const PointScalars& values, double level,
           std::function<double(const Vec3&)> exact, std::size_t most)
      : grid_(grid),
        axes_(axes),
        values_(values),
        level_(level),
        exact_(std::move(exact)),
        triangles_(most),
        row_(as_size(grid.points().x)),
        slice_(row_ * as_size(grid.points().y)) {
    for (auto& side : side_) side.resize(slice_);
    for (auto& flat : flat_) flat.assign(3 * slice_, kNone);
    up_.assign(4 * slice_, kNone);
  }

  Triangles run(Progress* progress) && {
    const Index3 n = grid_.points();
    classify(0, side_[0]);
    for (int k = 0; k + 1 < n.z; ++k) {
      if (progress) {
        progress->check();
        progress->advance();
      }
      classify(k + 1, side_[1]);
      for (int j = 0; j + 1 < n.y; ++j) {
        for (int i = 0; i + 1 < n.x; ++i) visit({i, j, k});
      }
      std::swap(side_[0], side_[1]);
      std::swap(flat_[0], flat_[1]);
      std::fill(flat_[1].begin(), flat_[1].end(), kNone);
      std::fill(up_.begin(), up_.end(), kNone);
    }
    return std::move(triangles_);
  }

 private:
  enum Side : std::uint8_t { kBelow = 0, kAbove = 1, kBad = 2 };

  void classify(int k, std::vector<std::uint8_t>& side) {
    const auto classify_all = [&](const auto& slice) {
      for (std::size_t i = 0; i < slice_; ++i) {
        const double s = static_cast<double>(slice[i]) * values_.scale;
        side[i] = !std::isfinite(s) ? kBad : s >= level_ ? kAbove : kBelow;
      }
    };
    if (const auto* sparse = std::get_if<SparseSpan>(&values_.values)) {
      const Index3 n = grid_.points();
      sparse_slice_.resize(slice_);
      sparse->numbers->copy({{0, 0, k}, {n.x, n.y, k + 1}}, sparse_slice_.data());
      return classify_all(sparse_slice_);
    }
    std::visit(
        [&](const auto& stored) {
          if constexpr (!std::is_same_v<std::decay_t<decltype(stored)>, SparseSpan>)
            classify_all(stored.subspan(as_size(k) * slice_, slice_));
        },
        values_.values);
  }

  /// Within a slice and to the next one: which of the eight corners, as bits x, y, z.
  [[nodiscard]] std::size_t offset(unsigned corner) const noexcept {
    return ((corner & 1U) != 0 ? 1 : 0) + ((corner & 2U) != 0 ? row_ : 0);
  }

  void visit(const Index3& index) {
    const std::size_t first = as_size(index.x) + row_ * as_size(index.y);
    std::array<std::uint8_t, 8> side{};
    unsigned any = 0, all = kAbove;
    for (unsigned c = 0; c < 8; ++c) {
      side[c] = side_[c >> 2U][first + offset(c)];
      any |= side[c];
      all &= side[c];
    }
    if ((any & kBad) != 0 || any == kBelow || all == kAbove) return;
    load_scalar_cell(grid_, values_, index, cell_);
    // Paths from corner to corner that set the bits x, y, z in each order.
    static constexpr std::array<std::array<unsigned, 4>, 6> kPaths{
        {{0, 1, 3, 7}, {0, 2, 6, 7}, {0, 4, 5, 7}, {0, 2, 3, 7}, {0, 4, 6, 7}, {0, 1, 5, 7}}};
    for (std::size_t t = 0; t < kPaths.size(); ++t) {
      const auto& path = kPaths[t];
      std::array<bool, 4> above{};
      for (std::size_t v = 0; v < 4; ++v) above[v] = side[path[v]] == kAbove;
      triangles_.cut(
          above, t >= 3,
          [&](int from, int to) {
            return vertex(first, path[as_size(std::min(from, to))], path[as_size(std::max(from, to))]);
          },
          [&](const Vec3& x) { return axes_.gradient_in_frame(cell_.gradient(axes_.along_axes(x))); });
    }
  }

  /// Along the axes.
  [[nodiscard]] Vec3 position(unsigned corner) const noexcept {
    return {(corner & 1U) != 0 ? cell_.upper.x : cell_.lower.x,
            (corner & 2U) != 0 ? cell_.upper.y : cell_.lower.y,
            (corner & 4U) != 0 ? cell_.upper.z : cell_.lower.z};
  }
  [[nodiscard]] double value(const Index3& index, unsigned corner) const noexcept {
    const std::size_t at = as_size(index.x) + row_ * as_size(index.y) + slice_ * as_size(index.z) +
                           offset(corner) + ((corner & 4U) != 0 ? slice_ : 0);
    return std::visit([&](const auto& stored) { return static_cast<double>(stored[at]) * values_.scale; },
                      values_.values) -
           level_;
  }

  /// The vertex on the edge from corner `low` to corner `high`, which has the bits of `low` and more.
  std::uint32_t vertex(std::size_t first, unsigned low, unsigned high) {
    const unsigned along = high & ~low;
    std::uint32_t& known = along < 4 ? flat_[low >> 2U][3 * (first + offset(low)) + along - 1]
                                     : up_[4 * (first + offset(low)) + along - 4];
    if (known != kNone) return known;
    const Vec3 a = position(low), d = position(high) - a;
    const double fa = value(cell_.index, low), fb = value(cell_.index, high);
    double part = 0.0;
    if (exact_) {
      const auto f = [&](double u) {
        const double there = exact_(a + u * d);
        return std::isfinite(there) ? there : fa + u * (fb - fa);  // a hole that the sampling misses
      };
      part = root_on_edge(f, fa, fb);
    } else if (along == 1 || along == 2 || along == 4) {
      part = fa / (fa - fb);  // linear there
    } else {
      part = root_on_edge([&](double u) { return cell_.value(a + u * d) - level_; }, fa, fb);
    }
    known = triangles_.add_point(axes_.in_frame(a + part * d));
    return known;
  }

  const BoxGrid& grid_;
  const BoxGrid& axes_;
  const PointScalars& values_;
  double level_;
  std::function<double(const Vec3&)> exact_;
  Triangles triangles_;
  std::size_t row_, slice_;
  std::vector<float> sparse_slice_;
  std::array<std::vector<std::uint8_t>, 2> side_;   // of the slices below and above
  std::array<std::vector<std::uint32_t>, 2> flat_;  // vertices on edges within them: x, y, xy of each point
  std::vector<std::uint32_t> up_;                   // between them: z, zx, yz, xyz
  ScalarBoxCell cell_;
};

/// A field as samples on a grid of boxes.
struct Sampling {
  std::optional<BoxGrid> grid;
  PointScalars values;
};

Sampling sample_at(std::array<std::vector<double>, 3> lines,
                   const std::function<double(const Vec3&)>& value) {
  auto numbers = std::make_shared<std::vector<double>>();
  numbers->reserve(lines[0].size() * lines[1].size() * lines[2].size());
  for (const double z : lines[2]) {
    for (const double y : lines[1]) {
      for (const double x : lines[0]) numbers->push_back(value({x, y, z}));
    }
  }
  Sampling sampling;
  sampling.grid.emplace(std::move(lines));
  sampling.values = {.values = std::span<const double>(*numbers), .scale = 1.0, .owner = numbers};
  return sampling;
}

/// Every `stride`-th grid line, and the last.
std::array<std::vector<double>, 3> thinned_lines(const BoxGrid& grid, int stride) {
  std::array<std::vector<double>, 3> lines;
  for (int axis = 0; axis < 3; ++axis) {
    const int last = grid.points()[axis] - 1;
    auto& line = lines[as_size(axis)];
    for (int i = 0; i < last; i += stride) line.push_back(grid.coordinate(axis, i));
    line.push_back(grid.coordinate(axis, last));
  }
  return lines;
}

/// Lines that cut the longest side of the box in `cells`.
std::array<std::vector<double>, 3> even_lines(const Box& box, int cells) {
  std::array<std::vector<double>, 3> lines;
  const Vec3 size = box.size();
  const double longest = std::max({size.x, size.y, size.z});
  for (int axis = 0; axis < 3; ++axis) {
    const int n = std::max(2, static_cast<int>(std::ceil(cells * size[axis] / longest)));
    auto& line = lines[as_size(axis)];
    for (int i = 0; i < n; ++i) line.push_back(box.lower[axis] + size[axis] * i / n);
    line.push_back(box.upper[axis]);
  }
  return lines;
}

IsosurfaceMesh mesh_of_boxes(const ScalarField& field, double level, std::size_t most, Progress* progress) {
  const double local = level * field.value_scale();
  constexpr int kFormulaCells = 96;  // along the longest side
  const BoxGrid* const grid = field.box_grid();
  CellHint hint;
  // Along the grid's axes: from frame L and back a place at the border might be outside.
  const auto value = [&](const Vec3& y) {
    if (grid != nullptr) {
      Index3 index;
      if (!grid->locate(y, index)) return std::nan("");
      ScalarBoxCell cell;
      load_scalar_cell(*grid, field.values(), index, cell);
      return cell.bad_data ? std::nan("") : cell.value(y);
    }
    Jet3 jet;
    return field.jet(y, hint, jet) == SampleStatus::kOk ? jet.value : std::nan("");
  };
  const auto exact = [&](const Vec3& y) { return value(y) - local; };
  for (int stride = 1;; stride *= 2) {
    const bool whole = grid != nullptr && stride == 1;
    Sampling sampling;
    if (!whole) {
      sampling = sample_at(grid != nullptr
                               ? thinned_lines(*grid, stride)
                               : even_lines(field.analytic()->bounds(), std::max(2, kFormulaCells / stride)),
                           value);
    }
    const BoxGrid& boxes = whole ? *grid : *sampling.grid;
    const Index3 n = boxes.points();
    if (progress) progress->begin("isosurface", static_cast<std::uint64_t>(n.z - 1));
    try {
      BoxMarch march(boxes, grid != nullptr ? *grid : boxes, whole ? field.values() : sampling.values, local,
                     whole ? std::function<double(const Vec3&)>() : exact, most);
      IsosurfaceMesh mesh = std::move(march).run(progress).finish(level, field.frame());
      mesh.stride = stride;
      return mesh;
    } catch (const TooMany&) {
      if (std::max({n.x, n.y, n.z}) <= 3) return {.level = level};
    }
  }
}

IsosurfaceMesh mesh_of_tets(const ScalarField& field, double level, std::size_t most, Progress* progress) {
  const TetMesh& mesh = *field.tet_mesh();
  const double local = level * field.value_scale();
  constexpr std::size_t kBetweenChecks = 4096;
  if (progress) progress->begin("isosurface", mesh.cells().size());
  Triangles triangles(most);
  std::unordered_map<std::uint64_t, std::uint32_t> vertices;  // by the edge's points
  for (std::size_t c = 0; c < mesh.cells().size(); ++c) {
    if (progress && c % kBetweenChecks == 0) {
      progress->check();
      progress->advance(kBetweenChecks);
    }
    const TetMesh::Tet& tet = mesh.cells()[c];
    const ScalarTet values = load_scalar_tet(field.values(), tet);
    if (values.bad_data) continue;
    std::array<bool, 4> above{};
    for (int v = 0; v < 4; ++v) above[as_size(v)] = values.s[v] >= local;
    Vec3 slope{0.0};
    const auto index = static_cast<CellIndex>(c);
    if (!mesh.zero_volume(index)) {
      slope = mesh.barycentric_gradients(index) *
              Vec3{values.s[1] - values.s[0], values.s[2] - values.s[0], values.s[3] - values.s[0]};
    }
    triangles.cut(
        above, false,
        [&](int i, int j) {
          // From the lower number on: the same bits from every cell around the edge.
          if (tet[as_size(i)] > tet[as_size(j)]) std::swap(i, j);
          const std::uint32_t a = tet[as_size(i)], b = tet[as_size(j)];
          const auto [known, fresh] = vertices.try_emplace((std::uint64_t{a} << 32U) | b, 0);
          if (fresh) {
            const double fa = values.s[i] - local, fb = values.s[j] - local;
            const Vec3 x = mesh.points()[a];
            known->second = triangles.add_point(x + (fa / (fa - fb)) * (mesh.points()[b] - x));
          }
          return known->second;
        },
        [&](const Vec3&) { return slope; });
  }
  return std::move(triangles).finish(level, field.frame());
}

}  // namespace

IsosurfaceMesh make_isosurface_mesh(const ScalarField& field, double level, std::size_t most_triangles,
                                    Progress* progress) {
  // No value is finite, or the level is not.
  if (!(field.lowest() <= field.highest()) || !std::isfinite(level * field.value_scale())) {
    return {.level = level};
  }
  if (field.tet_mesh() == nullptr) return mesh_of_boxes(field, level, most_triangles, progress);
  try {
    return mesh_of_tets(field, level, most_triangles, progress);
  } catch (const TooMany&) {
    throw work_error("the isosurface of " + field.name() + " has more than " +
                     std::to_string(most_triangles) + " triangles: it is haptic, but not drawn");
  }
}

}  // namespace palpate
