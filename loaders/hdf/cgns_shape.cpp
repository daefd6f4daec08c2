#include "loaders/hdf/cgns_shape.h"

#include <algorithm>
#include <array>
#include <span>
#include <string_view>

#include "common/base/index.h"
#include "common/base/text.h"

namespace palpate {
namespace {

constexpr std::int64_t kMixed = 20, kPolygons = 22, kPolyhedra = 23, kKinds = 57;

bool is_list(std::int64_t kind) noexcept { return kind == kPolygons || kind == kPolyhedra; }

/// The elements of one node.
struct Section {
  std::string node;
  std::int64_t kind, first, last;
};
constexpr std::uint64_t kAll = ~std::uint64_t{0};  // check_hdf5() holds them against the file

/// Collects one problem; functions return true where they found one.
class Shape {
 public:
  explicit Shape(const CgnsFile& file) : file_(file) {}

  CgnsProblem find() {
    for (const std::string& base : file_.children("/")) {
      const std::string node = "/" + base;
      if (file_.label(node) == "CGNSBase_t" && in_base(node)) break;
    }
    return found_;
  }

 private:
  bool problem(const std::string& node, const std::string& what) {
    found_ = {node, what};
    return true;
  }

  bool in_base(const std::string& base) {
    const std::vector<std::int64_t> sizes = file_.numbers(base);
    if (sizes.size() != 2 || sizes[0] < 1 || sizes[0] > sizes[1] || sizes[1] > 3)
      return problem(base, "has other dimensions than one to three");
    for (const std::string& child : file_.children(base)) {
      const std::string node = base + "/" + child;
      if (!file_.is_link(node) && file_.label(node) == "Zone_t" && in_zone(node, sizes[0], sizes[1]))
        return true;
    }
    return false;
  }

  bool in_zone(const std::string& zone, std::int64_t dimensions, std::int64_t axes) {
    const std::string type = file_.word(zone + "/ZoneType");
    if (type != "Structured" && type != "Unstructured")
      return problem(zone, "does not say whether it is structured");
    const std::vector<std::int64_t> sizes = file_.numbers(zone);
    const std::size_t of_points = type == "Structured" ? as_size(dimensions) : 1;
    if (sizes.size() != 3 * of_points) return problem(zone, "has sizes of another number of axes");
    std::int64_t points = 1;
    for (std::size_t i = 0; i < of_points; ++i) {
      const std::int64_t cells = sizes[of_points + i];
      const bool fits = sizes[i] >= 1 && cells >= 0 && (type != "Structured" || cells == sizes[i] - 1);
      if (!fits || __builtin_mul_overflow(points, sizes[i], &points))
        return problem(zone, "has sizes that are of no grid");
    }
    bool placed = false;
    sections_.clear();
    for (const std::string& child : file_.children(zone)) {
      const std::string node = zone + "/" + child, kind = file_.label(node);
      if (file_.is_link(node)) {
        placed = true;
        continue;
      }
      if (kind == "GridCoordinates_t") {
        placed = true;
        if (in_coordinates(node, axes) || in_rind(node, of_points)) return true;
      }
      if (kind == "FlowSolution_t" && in_solution(node, of_points)) return true;
      if (kind == "Elements_t" && in_elements(node, points)) return true;
    }
    if (!placed) return problem(zone, "has no coordinates");
    return type == "Unstructured" && (in_numbers(sizes[1]) || in_faces());
  }

  /// Elements that are numbered as the cells of the zone are laid by VTK's reader at their numbers.
  bool in_numbers(std::int64_t cells) {
    std::vector<Section> in_zone;
    for (const Section& section : sections_) {
      if (is_list(section.kind)) return false;  // each list by itself
      if (section.first <= cells) in_zone.push_back(section);
    }
    std::ranges::sort(in_zone, {}, &Section::first);
    std::int64_t last = 0;
    for (const Section& section : in_zone) {
      if (section.first != last + 1)
        return problem(section.node, "has elements with numbers from " + std::to_string(section.first) +
                                         " on, expected " + std::to_string(last + 1));
      last = section.last;
    }
    return false;
  }

  /// The faces of polyhedra are among the polygons.
  bool in_faces() {
    for (const Section& cells : sections_) {
      if (cells.kind != kPolyhedra) continue;
      const bool counted = !file_.has(cells.node + "/ElementStartOffset");
      const std::vector<std::int64_t> all = file_.numbers(cells.node + "/ElementConnectivity", kAll);
      for (std::size_t i = 0, ahead = 0; i < all.size(); ++i) {
        if (counted && ahead == 0) {
          ahead = as_size(all[i]);
          continue;
        }
        if (counted) --ahead;
        const std::int64_t face = all[i] < 0 ? -all[i] : all[i];
        const bool there = std::ranges::any_of(sections_, [face](const Section& faces) {
          return faces.kind == kPolygons && face >= faces.first && face <= faces.last;
        });
        if (!there) return problem(cells.node, "has polyhedra of faces that are not there");
      }
    }
    return false;
  }

  bool in_coordinates(const std::string& node, std::int64_t axes) {
    if (file_.has(node + "/CoordinateR") || file_.has(node + "/CoordinateTheta"))
      return false;  // refused behind
    for (std::int64_t axis = 0; axis < axes; ++axis) {
      const std::string array = node + "/Coordinate" + "XYZ"[axis];
      if (file_.is_link(array)) continue;
      if (file_.label(array) != "DataArray_t" || file_.count(array) == 0)
        return problem(node, std::string("has no Coordinate") + "XYZ"[axis]);
    }
    return false;
  }

  bool in_solution(const std::string& node, std::size_t axes) {
    static constexpr std::array<std::string_view, 7> kPlaces{
        "Vertex", "CellCenter", "FaceCenter", "IFaceCenter", "JFaceCenter", "KFaceCenter", "EdgeCenter"};
    const std::string place = node + "/GridLocation";
    if (file_.has(place) && std::ranges::find(kPlaces, file_.word(place)) == kPlaces.end())
      return problem(place, "is no place that values can have");
    return in_rind(node, axes);
  }

  bool in_rind(const std::string& node, std::size_t axes) {
    const std::string rind = node + "/Rind";
    if (!file_.has(rind)) return false;
    const std::vector<std::int64_t> layers = file_.numbers(rind);
    const bool fits = layers.size() == 2 * axes &&
                      std::ranges::all_of(layers, [](std::int64_t n) { return n >= 0 && n < 1000; });
    return !fits && problem(rind, "has other layers than two along each axis");
  }

  bool in_elements(const std::string& node, std::int64_t points) {
    const std::vector<std::int64_t> about = file_.numbers(node),
                                    range = file_.numbers(node + "/ElementRange");
    if (about.size() != 2 || about[0] < 2 || about[0] >= kKinds)
      return problem(node, "has elements of no kind");
    if (range.size() != 2 || range[0] < 1 || range[1] < range[0])
      return problem(node, "has elements of no numbers");
    const std::string list = node + "/ElementConnectivity";
    if (file_.axes(list) != 1) return problem(node, "has no list of the points of its elements");
    sections_.push_back({node, about[0], range[0], range[1]});
    const std::vector<std::int64_t> corners = file_.numbers(list, kAll);
    const auto count = static_cast<std::uint64_t>(range[1] - range[0]) + 1;
    if (corners.empty() || count > corners.size()) return problem(node, "has fewer points than elements");
    if (is_list(about[0])) return in_lists(node, about[0], count, points, corners);
    if (about[0] == kMixed) return in_mixed(node, count, points, corners);
    if (const std::uint64_t wanted = nodes_of_element(about[0]);
        corners.size() % wanted != 0 || corners.size() / wanted != count)
      return problem(node, "has " + std::to_string(corners.size()) + " points of " + std::to_string(count) +
                               " elements, expected " + std::to_string(wanted) + " each");
    return !are_points(corners, points) && problem(node, "has elements of points that are not there");
  }

  static bool are_points(std::span<const std::int64_t> all, std::int64_t points) {
    return std::ranges::all_of(all, [points](std::int64_t p) { return p >= 1 && p <= points; });
  }

  bool in_mixed(const std::string& node, std::uint64_t count, std::int64_t points,
                const std::vector<std::int64_t>& corners) {
    std::uint64_t elements = 0;
    std::size_t at = 0;
    for (; at < corners.size(); ++elements) {
      const std::uint64_t nodes = nodes_of_element(corners[at]);
      if (nodes == 0 || nodes > corners.size() - at - 1) return problem(node, "has elements of no kind");
      if (!are_points({corners.data() + at + 1, nodes}, points))
        return problem(node, "has elements of points that are not there");
      at += 1 + nodes;
    }
    return elements != count &&
           problem(node, "has " + std::to_string(elements) + " elements, expected " + std::to_string(count));
  }

  /// Faces of points, or polyhedra of faces: behind offsets, or before 3.4 each behind its count.
  bool in_lists(const std::string& node, std::int64_t kind, std::uint64_t count, std::int64_t points,
                const std::vector<std::int64_t>& corners) {
    const std::vector<std::int64_t> offsets = file_.numbers(node + "/ElementStartOffset", kAll);
    if (!file_.has(node + "/ElementStartOffset")) return in_counted(node, kind, count, points, corners);
    if (offsets.size() != count + 1 || offsets.front() != 0 || !std::ranges::is_sorted(offsets) ||
        as_size(offsets.back()) != corners.size())
      return problem(node, "has offsets that do not fit its elements");
    return in_list(node, kind, points, corners);
  }

  bool in_list(const std::string& node, std::int64_t kind, std::int64_t points,
               std::span<const std::int64_t> corners) {
    if (kind == kPolygons)
      return !are_points(corners, points) && problem(node, "has faces of points that are not there");
    return std::ranges::find(corners, INT64_MIN) != corners.end() &&
           problem(node, "has polyhedra of faces that are not there");
  }

  bool in_counted(const std::string& node, std::int64_t kind, std::uint64_t count, std::int64_t points,
                  const std::vector<std::int64_t>& corners) {
    std::uint64_t elements = 0;
    std::size_t at = 0;
    for (; at < corners.size(); ++elements) {
      if (corners[at] < 1 || as_size(corners[at]) > corners.size() - at - 1)
        return problem(node, "has elements of no size");
      const std::size_t n = as_size(corners[at]);
      if (in_list(node, kind, points, {corners.data() + at + 1, n})) return true;
      at += 1 + n;
    }
    return elements != count &&
           problem(node, "has " + std::to_string(elements) + " elements, expected " + std::to_string(count));
  }

  const CgnsFile& file_;
  CgnsProblem found_;
  std::vector<Section> sections_;  // of the zone that is looked at
};

}  // namespace

std::uint64_t nodes_of_element(std::int64_t kind) noexcept {
  constexpr std::array<std::uint64_t, kKinds> kNodes{
      0,  0,  1,  2,  3,  3,  6,  4,  8,  9,  4,  10, 5,  14, 6,  15, 18, 8,  20,
      27, 0,  13, 0,  0,  4,  9,  10, 12, 16, 16, 20, 21, 29, 30, 24, 38, 40, 32,
      56, 64, 5,  12, 15, 16, 25, 22, 34, 35, 29, 50, 55, 33, 66, 75, 44, 98, 125};
  return kind >= 0 && as_size(kind) < kNodes.size() ? kNodes[as_size(kind)] : 0;
}

CgnsProblem find_cgns_problem(const CgnsFile& file) { return Shape(file).find(); }

}  // namespace palpate
