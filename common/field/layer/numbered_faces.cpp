#include "common/field/layer/numbered_faces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "common/base/error.h"
#include "common/base/index.h"
#include "common/base/text.h"
#include "common/field/cells/same_place.h"
#include "common/field/grid/cell_faces.h"
#include "common/field/region_names.h"

namespace palpate {
namespace {

constexpr double kLargestNumber = 2e9;

bool is_inner(int tag) {
  return role_of_tag(tag) == BorderRole::kInner || role_of_tag(tag) == BorderRole::kRight;
}
bool is_outer(int tag) {
  return role_of_tag(tag) == BorderRole::kOuter || role_of_tag(tag) == BorderRole::kSeptum;
}

/// The first one counts.
constexpr std::array<BorderRole, 5> kOrder{BorderRole::kInner, BorderRole::kRight, BorderRole::kSeptum,
                                           BorderRole::kOuter, BorderRole::kBase};

std::string text_of(std::int64_t number, const FaceWords& words) {
  const auto name = words.names.find(number);
  return std::to_string(number) + (name == words.names.end() ? "" : " '" + name->second + "'");
}

template <typename Numbers>
std::string list_of(const Numbers& numbers, const FaceWords& words) {
  constexpr std::size_t kMost = 12;
  std::string text;
  std::size_t listed = 0;
  for (const auto& [number, count] : numbers) {
    if (listed++ == kMost) return text + ", … (" + std::to_string(numbers.size()) + " in all)";
    text += (text.empty() ? "" : ", ") + text_of(number, words);
  }
  return text;
}

FaceRoles roles_by_name(const FaceWords& words) {
  FaceRoles roles;
  for (const auto& [number, name] : words.names)
    if (const BorderRole role = role_of_name(name); role != BorderRole::kLeft) roles.emplace(number, role);
  return roles;
}

}  // namespace

BorderRole role_of_name(const std::string& given) {
  const std::string name = lowered(given);
  const auto has = [&name](std::string_view word) { return name.find(word) != std::string::npos; };
  // Two letters stand at an end of a part of the name: "nerve" is no right ventricle, and "baseline" no base.
  const auto has_part = [&name](std::string_view word, bool whole) {
    std::size_t begin = 0;
    while (begin < name.size()) {
      const std::size_t end = std::min(name.find_first_of("._- ", begin), name.size());
      const std::string_view part = std::string_view(name).substr(begin, end - begin);
      if (whole ? part == word : part.starts_with(word) || part.ends_with(word)) return true;
      begin = end + 1;
    }
    return false;
  };
  if (has("epi")) return BorderRole::kOuter;
  if (has_part("base", true)) return BorderRole::kBase;
  if (has("sept")) return has_part("lv", false) ? BorderRole::kInner : BorderRole::kSeptum;
  if (has_part("rv", false) || (has("right") && has("endo"))) return BorderRole::kRight;
  return has("endo") || has_part("lv", false) ? BorderRole::kInner : BorderRole::kLeft;
}

void PointTags::mark(std::int64_t point, BorderRole role) {
  double& tag = tags_[as_size(point)];
  const int before = static_cast<int>(tag), now = tag_of(role);
  if ((is_inner(before) && is_outer(now)) || (is_outer(before) && is_inner(now))) {
    crossed_.resize(tags_.size());
    if (!crossed_[as_size(point)]) ++both_;
    crossed_[as_size(point)] = true;
  }
  const auto place = [](BorderRole of) { return std::find(kOrder.begin(), kOrder.end(), of); };
  if (before == 0 || place(role) < place(role_of_tag(before))) tag = now;
}

FaceRoles parse_surface_markers(const std::string& asked, const std::set<std::int64_t>& known,
                                const std::string& file) {
  constexpr std::array<BorderRole, 4> kSides{BorderRole::kInner, BorderRole::kOuter, BorderRole::kRight,
                                             BorderRole::kBase};
  std::string list;
  for (const std::int64_t number : known) list += (list.empty() ? "" : ", ") + std::to_string(number);
  const auto refuse = [&](const std::string& why) {
    throw usage_error("--surface-markers " + asked + ": " + why + "; " + file + " has the markers " +
                      (known.empty() ? "none" : list));
  };
  const auto sides = split(asked, '/');
  if (sides.size() < 2 || sides.size() > kSides.size())
    refuse(
        "inner and outer ones are expected, as 1,4/2, and perhaps right inner ones and those of the base, "
        "as 1/2/3/5");
  FaceRoles roles;
  for (std::size_t side = 0; side < sides.size(); ++side) {
    for (const std::string_view text : split(sides[side], ',')) {
      const auto value = number(text);
      const auto marker =
          value ? static_cast<std::int64_t>(std::clamp(*value, -kLargestNumber, kLargestNumber)) : 0;
      if (!value || static_cast<double>(marker) != *value || !known.contains(marker))
        refuse("'" + std::string(text) + "' is no marker of it");
      const auto [at, added] = roles.emplace(marker, kSides[side]);
      if (!added && at->second != kSides[side])
        refuse("marker " + std::to_string(marker) + " is on both sides");
    }
  }
  return roles;
}

void NumberedFaces::add(std::span<const std::int64_t> of, std::int64_t number) {
  points.insert(points.end(), of.begin(), of.end());
  offsets.push_back(static_cast<std::int64_t>(points.size()));
  numbers.push_back(number);
}

std::string face_array(const std::vector<ArrayInfo>& arrays) {
  constexpr std::array<std::string_view, 22> kNames{
      "surface",     "facet",        "facets",     "facet_tags",     "facet_markers", "facet_region",
      "face_marker", "face_markers", "marker",     "markers",        "boundary",      "boundaries",
      "boundary_id", "boundaryid",   "surface_id", "surfaceid",      "surface_tags",  "medit:ref",
      "patch",       "cell_tags",    "sideset",    "boundary_marker"};
  std::string found;
  for (const ArrayInfo& array : arrays) {
    if (array.association != Association::kCell || array.components != 1) continue;
    if (array.name == kSurfaceArray) return array.name;
    if (found.empty() && (numbers_regions(array.name) ||
                          std::ranges::count(kNames, std::string_view(lowered(array.name))) > 0))
      found = array.name;
  }
  return found;
}

NumberedFaces faces_of_mesh(const UnstructuredTopology& cells, const DataArray& numbers) {
  NumberedFaces faces;
  if (numbers.tuples != cells.types.size() || numbers.components != 1) return faces;
  const bool volumes =
      std::any_of(cells.types.begin(), cells.types.end(), [](std::uint8_t type) { return !is_flat(type); });
  for (std::size_t c = 0; volumes && c < cells.types.size(); ++c) {
    const double value = numbers.at(c);
    if (!is_surface(cells.types[c]) || value == 0.0 || value != std::floor(value) ||
        std::abs(value) > kLargestNumber)
      continue;
    const auto begin = as_size(cells.offsets[c]), end = as_size(cells.offsets[c + 1]);
    const std::span<const std::int64_t> of(cells.connectivity.data() + begin, end - begin);
    const std::size_t points = cells.positions.tuples;
    if (of.size() < 3 ||
        std::ranges::any_of(of, [points](std::int64_t p) { return p < 0 || as_size(p) >= points; }))
      continue;
    faces.add(of, static_cast<std::int64_t>(value));
  }
  return faces;
}

std::vector<double> surfaces_of_faces(const NumberedFaces& faces, std::size_t points, const FaceWords& words,
                                      std::vector<std::string>& notes) {
  std::map<std::int64_t, std::size_t> counts;
  for (const std::int64_t number : faces.numbers) ++counts[number];
  std::set<std::int64_t> known;
  for (const auto& [number, count] : counts) known.insert(number);
  const bool asked = !words.asked.empty();
  if (counts.empty() && !asked) return {};
  const FaceRoles roles =
      asked ? parse_surface_markers(words.asked, known, words.file) : roles_by_name(words);
  const auto any = [&](bool (*is)(int)) {
    return std::any_of(roles.begin(), roles.end(), [&](const auto& each) {
      return counts.contains(each.first) && is(tag_of(each.second));
    });
  };
  if (!any(is_inner) || !any(is_outer)) {
    notes.push_back(counted(faces.numbers.size(), "face") + " of the border with the numbers " +
                    list_of(counts, words) + " of " + words.numbered_by +
                    ": not taken for surfaces, as no names say endocardium (endo) and epicardium (epi); "
                    "--surface-markers INNER/OUTER, as 1,4/2, takes them");
    return {};
  }
  PointTags tags(points);
  for (std::size_t f = 0; f < faces.numbers.size(); ++f) {
    const auto role = roles.find(faces.numbers[f]);
    if (role == roles.end()) continue;
    for (std::int64_t i = faces.offsets[f]; i < faces.offsets[f + 1]; ++i)
      tags.mark(faces.points[as_size(i)], role->second);
  }
  std::map<std::int64_t, std::size_t> left;
  for (const auto& [number, count] : counts) {
    const auto role = roles.find(number);
    if (role == roles.end()) {
      left.emplace(number, count);
      continue;
    }
    const bool one = role->second == BorderRole::kInner &&
                     std::none_of(roles.begin(), roles.end(),
                                  [](const auto& each) { return each.second == BorderRole::kRight; });
    notes.push_back("number " + text_of(number, words) + " of " + words.numbered_by + " is the " +
                    (one ? "endocardium" : name_of(role->second)) + (asked ? "" : ", by its name") + ": " +
                    counted(count, "face"));
  }
  if (!left.empty())
    notes.push_back("faces with the numbers " + list_of(left, words) + " of " + words.numbered_by +
                    " are of no surface");
  if (tags.points_of_both_sides() > 0)
    notes.push_back(counted(tags.points_of_both_sides(), "point") + " on both surfaces: taken as inner");
  return tags.values();
}

std::vector<double> surfaces_of_cells(const DataSet& block, const std::string& array, const std::string& file,
                                      const std::string& asked, std::vector<std::string>& notes) {
  const auto* const cells = std::get_if<UnstructuredTopology>(&block.topology);
  const DataArray* const numbers = block.find(array, Association::kCell);
  NumberedFaces faces;
  if (cells != nullptr && numbers != nullptr) faces = faces_of_mesh(*cells, *numbers);
  // Faces that were put beside the mesh may have points of their own: those of volumes are joined with the first.
  std::vector<std::int64_t> first;
  if (!faces.numbers.empty()) first = first_at_place(cells->positions);
  for (std::int64_t& point : faces.points) point = first[as_size(point)];
  FaceWords words{.file = file, .numbered_by = "'" + array + "'", .names = {}, .asked = asked};
  for (int tag = 1; array == kSurfaceArray && tag < kBorderRoleCount; ++tag)
    words.names[tag] = name_of(role_of_tag(tag));
  std::vector<double> tags = surfaces_of_faces(faces, block.point_count(), words, notes);
  for (std::size_t p = 0; p < tags.size(); ++p) tags[p] = tags[as_size(first[p])];
  return tags;
}

}  // namespace palpate
