#include "loaders/cardiac/marked_faces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <initializer_list>
#include <map>
#include <set>
#include <span>
#include <string_view>
#include <utility>

#include "common/base/error.h"
#include "common/base/index.h"
#include "common/base/text.h"
#include "common/field/layer/numbered_faces.h"
#include "common/field/layer/wall_surfaces.h"
#include "common/math/symmetric3.h"
#include "common/math/vec.h"
#include "loaders/cardiac/mesh_text.h"
#include "loaders/cardiac/text_lines.h"

namespace palpate {
namespace {

constexpr double kSmallPart = 0.01;  // of the area of all triangles, as for parts of a border
constexpr double kFlat = 0.99;       // of a part's area, that its normals add up to

using Triple = std::array<std::int64_t, 3>;

struct MarkedFace {
  Triple corners{};  ///< rising
  std::int64_t marker = 0;
  std::size_t line = 0;
  bool found = false;  ///< it is one of an element
};

struct FacesOfFile {
  bool marked = false;
  std::size_t longer = 0;         ///< rows with a number more than the first line says
  std::vector<MarkedFace> faces;  ///< those on a surface
};

/// The numbers of a row. @throws Error (bad input) for what is no whole number.
std::vector<std::int64_t> row_of(TextLines& lines, std::size_t read, std::size_t count) {
  do {
    if (!lines.next()) lines.refuse("ends after " + counted(read, "face"), std::to_string(count));
  } while (lines.line().empty());
  std::vector<std::int64_t> row;
  for (std::string_view word = lines.word_here(); !word.empty(); word = lines.word_here()) {
    const auto value = number(word);
    constexpr double kLargest = 2e9;
    if (!value || !(std::abs(*value) <= kLargest) || *value != std::trunc(*value))
      lines.refuse("has \"" + std::string(word.substr(0, 40)) + "\"", "a whole number");
    row.push_back(static_cast<std::int64_t>(*value));
  }
  return row;
}

FacesOfFile read_faces(const std::string& file, std::int64_t first_node, std::size_t nodes) {
  constexpr std::size_t kLeastBytes = 8;  // "0 1 2 3\n"
  TextLines lines(file, '#');
  const std::size_t count = believed_count(lines, "the number of faces", kLeastBytes);
  FacesOfFile out;
  out.marked = lines.integer("0 or 1 for boundary markers,", 0, 1) == 1;
  const std::size_t tail = out.marked ? 1 : 0;
  std::int64_t first = 0;
  for (std::size_t f = 0; f < count; ++f) {
    const std::vector<std::int64_t> row = row_of(lines, f, count);
    // Behind the number and the marker three or six nodes, and with -nn the elements on both sides.
    std::size_t rest = row.size() - std::min(row.size(), 1 + tail);
    // One number more stands in files of Chaste's, which reads it only where the first line says so.
    if (rest == 4 || rest == 7) {
      --rest;
      ++out.longer;
    }
    if (rest != 3 && rest != 5 && rest != 6 && rest != 8)
      lines.refuse("has a row of " + counted(row.size(), "number"),
                   std::string("a number, 3 or 6 nodes") + (out.marked ? " and a marker" : ""));
    if (f == 0) first = row[0];
    const std::int64_t next = first + static_cast<std::int64_t>(f);
    if (row[0] != next || first < 0 || first > 1)
      lines.refuse("has \"" + std::to_string(row[0]) + "\"",
                   f == 0 ? "0 or 1, the number of the first face"
                          : "the next face's number, " + std::to_string(next));
    const std::size_t used = rest >= 6 ? 6 : 3;
    const std::int64_t last = first_node + static_cast<std::int64_t>(nodes) - 1;
    for (std::size_t n = 1; n <= used; ++n)
      if (row[n] < first_node || row[n] > last)
        lines.refuse("has \"" + std::to_string(row[n]) + "\"",
                     "a node of the face, " + std::to_string(first_node) + " to " + std::to_string(last));
    MarkedFace face{.marker = out.marked ? row[1 + used] : 0, .line = lines.line_number()};
    for (std::size_t n = 0; n < 3; ++n) face.corners[n] = row[1 + n] - first_node;
    std::sort(face.corners.begin(), face.corners.end());
    if (face.marker != 0) out.faces.push_back(face);
  }
  if (!lines.word().empty())
    lines.refuse("has more than the " + counted(count, "face") + " of its first line", "");
  return out;
}

/// What the triangles of one marker look like together.
struct Part {
  double area = 0.0;
  Mat3 normals{0.0};  ///< sum of area n n^T, whatever the triangles' orientation
  Box bounds;
  [[nodiscard]] bool flat() const { return symmetric_eigenvalues(normals)[0] > kFlat * kFlat * area; }
};

std::map<std::int64_t, Part> parts_of(const std::vector<MarkedFace>& faces, const DataArray& positions) {
  std::map<std::int64_t, Part> parts;
  for (const MarkedFace& face : faces) {
    std::array<Vec3, 3> x{};
    for (std::size_t n = 0; n < 3; ++n)
      for (int axis = 0; axis < 3; ++axis) x[n][axis] = positions.at(as_size(face.corners[n]), axis);
    const Vec3 twice = glm::cross(x[1] - x[0], x[2] - x[0]);
    const double length = glm::length(twice);
    Part& part = parts[face.marker];
    for (const Vec3& corner : x) part.bounds.include(corner);
    part.area += 0.5 * length;
    if (length > 0.0) part.normals += glm::outerProduct(twice, twice) * (0.5 / length);
  }
  return parts;
}

/// None where the shapes leave it open.
FaceRoles by_shape(const std::map<std::int64_t, Part>& parts) {
  double area = 0.0;
  for (const auto& [marker, part] : parts) area += part.area;
  FaceRoles roles;
  double largest = 0.0;
  for (const auto& [marker, part] : parts) {
    if (part.area < kSmallPart * area || part.flat()) continue;
    const bool outer = part.bounds.diagonal() > largest;
    if (outer) {
      for (auto& [other, role] : roles) role = BorderRole::kInner;
      largest = part.bounds.diagonal();
    }
    roles[marker] = outer ? BorderRole::kOuter : BorderRole::kInner;
  }
  // Of three one may be a base that is not flat, or another ventricle's.
  return roles.size() == 2 ? roles : FaceRoles{};
}

std::string list_of(const FaceRoles& roles, BorderRole role) {
  std::string text;
  for (const auto& [marker, of] : roles)
    if (of == role) text += (text.empty() ? "" : ", ") + std::to_string(marker);
  return text;
}

/// Marks the nodes of a face of an element, those on its edges included.
/// @param cell 4 or 10 nodes in VTK's order. @param opposite the corner that is not of the face.
void mark(std::span<const std::int64_t> cell, std::size_t opposite, BorderRole role, PointTags& tags) {
  /// The edges that the fifth to tenth node halve.
  constexpr std::array<std::array<std::size_t, 2>, 6> kHalved{
      {{0, 1}, {1, 2}, {0, 2}, {0, 3}, {1, 3}, {2, 3}}};
  for (std::size_t n = 0; n < 4; ++n)
    if (n != opposite) tags.mark(cell[n], role);
  for (std::size_t e = 0; 4 + e < cell.size(); ++e)
    if (kHalved[e][0] != opposite && kHalved[e][1] != opposite) tags.mark(cell[4 + e], role);
}

}  // namespace

void add_marked_surfaces(const std::string& file, std::int64_t first_node, const std::string& markers,
                         DataSet& mesh, std::vector<std::string>& notes) {
  const auto& cells = std::get<UnstructuredTopology>(mesh.topology);
  const std::size_t nodes = mesh.point_count();
  FacesOfFile read = read_faces(file, first_node, nodes);
  if (read.longer > 0)
    notes.push_back(counted(read.longer, "row") + " of " + file +
                    " with a number more than its first line says of a face: left out");
  const std::map<std::int64_t, Part> parts = parts_of(read.faces, cells.positions);
  if (markers.empty() && parts.size() < 2) {
    notes.push_back(file + " has no markers that tell surfaces apart");
    return;
  }
  std::set<std::int64_t> known;
  for (const auto& [marker, part] : parts) known.insert(marker);
  const FaceRoles roles = markers.empty() ? by_shape(parts) : parse_surface_markers(markers, known, file);
  if (roles.empty()) {
    std::string list;
    for (const std::int64_t marker : known) list += (list.empty() ? "" : ", ") + std::to_string(marker);
    notes.push_back("the markers " + list + " of " + file +
                    " do not tell one inner and one outer surface by their shape: --surface-markers "
                    "INNER/OUTER, as 1,4/2, takes them");
    return;
  }

  std::vector<MarkedFace>& faces = read.faces;
  std::sort(faces.begin(), faces.end(), [](const MarkedFace& a, const MarkedFace& b) {
    return a.corners != b.corners ? a.corners < b.corners : a.line < b.line;
  });
  PointTags tags(nodes);
  for (std::size_t c = 0; c < cells.types.size(); ++c) {
    const auto begin = as_size(cells.offsets[c]), end = as_size(cells.offsets[c + 1]);
    const std::span<const std::int64_t> cell(cells.connectivity.data() + begin, end - begin);
    for (std::size_t opposite = 0; opposite < 4; ++opposite) {
      Triple corners{};
      for (std::size_t n = 0, to = 0; n < 4; ++n)
        if (n != opposite) corners[to++] = cell[n];
      std::sort(corners.begin(), corners.end());
      auto face = std::lower_bound(faces.begin(), faces.end(), corners,
                                   [](const MarkedFace& a, const Triple& b) { return a.corners < b; });
      for (; face != faces.end() && face->corners == corners; ++face) {
        face->found = true;
        if (const auto role = roles.find(face->marker); role != roles.end())
          mark(cell, opposite, role->second, tags);
      }
    }
  }
  const MarkedFace* lost = nullptr;
  for (const MarkedFace& face : faces)
    if (!face.found && (lost == nullptr || face.line < lost->line)) lost = &face;
  if (lost != nullptr) {
    std::string names;
    for (const std::int64_t corner : lost->corners)
      names += (names.empty() ? "" : ", ") + std::to_string(corner + first_node);
    throw input_error({file, "line " + std::to_string(lost->line), "has a triangle of the nodes " + names,
                       "a face of an element"});
  }
  mesh.arrays.push_back(
      make_array(kSurfaceArray, Association::kPoint, 1, std::span<const double>(tags.values())));
  std::string sides;
  for (const auto& [role, name] : std::initializer_list<std::pair<BorderRole, const char*>>{
           {BorderRole::kInner, "the inner"},
           {BorderRole::kOuter, "the outer surface"},
           {BorderRole::kRight, "the right endocardium"},
           {BorderRole::kBase, "the base"}})
    if (const std::string list = list_of(roles, role); !list.empty())
      sides += (sides.empty() ? "" : ", ") + ("marker " + list) + " is " + name;
  notes.push_back("of " + file + " " + sides + (markers.empty() ? ", by their shape" : ""));
  if (tags.points_of_both_sides() > 0)
    notes.push_back(counted(tags.points_of_both_sides(), "point") + " on both surfaces: taken as inner");
}

}  // namespace palpate
