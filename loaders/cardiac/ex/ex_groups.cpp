#include "loaders/cardiac/ex/ex_groups.h"

#include <algorithm>
#include <set>
#include <string_view>

#include "common/base/index.h"
#include "common/base/text.h"
#include "common/field/layer/numbered_faces.h"
#include "common/field/layer/wall_surfaces.h"

namespace palpate::ex {
namespace {

/// What a group is by its name; kLeft: no surface. "lv" alone may be a part of the wall.
BorderRole role_of_group(const std::string& name) {
  const std::string low = lowered(name);
  const auto has = [&low](std::string_view word) { return low.find(word) != std::string::npos; };
  return has("epi") || has("endo") ? role_of_name(name) : BorderRole::kLeft;
}

/// Whether a face of a cube is in a group: by its number, or by its nodes.
bool has_face(const Group& group, const Element& element, std::size_t axis, std::size_t end) {
  constexpr std::size_t kFaces = 6, kCorners = 8, kLeastNodes = 3;
  if (element.faces.size() == kFaces && group.faces.contains(element.faces[2 * axis + end])) return true;
  if (element.nodes.size() != kCorners) return false;
  std::set<std::int64_t> nodes;
  for (std::size_t c = 0; c < kCorners; ++c) {
    if ((c >> axis & 1U) != end) continue;
    if (!group.nodes.contains(element.nodes[c])) return false;
    nodes.insert(element.nodes[c]);
  }
  return nodes.size() >= kLeastNodes;
}

}  // namespace

std::vector<double> group_surfaces(const Model& model, const SampledPlaces& places,
                                   std::vector<std::string>& notes) {
  PointTags tags(places.points);
  std::vector<std::string> taken;
  bool inner = false, outer = false;
  const auto named = [](const auto& group) { return role_of_group(group.first) != BorderRole::kLeft; };
  if (std::ranges::none_of(model.groups, named)) return {};
  const bool cubes =
      std::ranges::all_of(model.elements, [](const Element& element) { return element.linked == Linked{}; });
  if (!cubes) {
    notes.emplace_back("groups name surfaces, and elements are no cubes: surfaces are found by shape");
    return {};
  }
  for (const auto& [name, group] : model.groups) {
    const BorderRole role = role_of_group(name);
    if (role == BorderRole::kLeft) continue;
    std::size_t faces = 0;
    for (std::size_t e = 0; e < model.elements.size(); ++e) {
      const std::vector<Vec3>& xi = places.of_element[e]->xi;
      for (int axis = 0; axis < 3; ++axis) {
        for (const std::size_t end : {std::size_t{0}, std::size_t{1}}) {
          if (!has_face(group, model.elements[e], as_size(axis), end)) continue;
          ++faces;
          for (std::size_t p = 0; p < xi.size(); ++p)
            if (xi[p][axis] == static_cast<double>(end))
              tags.mark(places.point_of[places.first[e] + p], role);
        }
      }
    }
    if (faces == 0) continue;
    (role == BorderRole::kOuter ? outer : inner) = true;
    taken.push_back("group '" + name + "' is the " + name_of(role) +
                    ", by its name: " + counted(faces, "face"));
  }
  if (!inner || !outer) {
    notes.emplace_back(
        "groups that name a surface are left out: faces of one with \"endo\" and of one with \"epi\" in its "
        "name are needed");
    return {};
  }
  notes.insert(notes.end(), taken.begin(), taken.end());
  return tags.values();
}

}  // namespace palpate::ex
