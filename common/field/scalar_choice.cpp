#include "common/field/scalar_choice.h"

#include <algorithm>
#include <array>

#include "common/base/error.h"
#include "common/base/text.h"
#include "common/field/region_names.h"

namespace palpate {

bool numbers_regions(const std::string& name) {
  constexpr std::array<std::string_view, 14> kNames{
      "region",   "regions",     "region_id", "regionid",  "tag",           "tags",          "elemtag",
      "elem_tag", "element_tag", "material",  "materials", "cellentityids", "gmsh:physical", "label"};
  return std::find(kNames.begin(), kNames.end(), lowered(name)) != kNames.end();
}

double number_of(const DataArray& array, std::size_t tuple, int component) noexcept {
  if (component != ScalarChoice::kMagnitude) return array.at(tuple, component);
  double norm = 0.0;
  for (int c = 0; c < array.components; ++c) norm = std::hypot(norm, array.at(tuple, c));
  return norm;
}

std::string label_of(const ScalarChoice& choice, const std::vector<ArrayInfo>& arrays) {
  const bool several = std::any_of(arrays.begin(), arrays.end(), [&](const ArrayInfo& array) {
    return array.name == choice.array && array.association == choice.association && array.components > 1;
  });
  if (!several) return choice.array;
  return choice.array + (choice.component == ScalarChoice::kMagnitude
                             ? ":magnitude"
                             : ":" + std::to_string(choice.component));
}

std::vector<ScalarChoice> scalar_choices(const std::vector<ArrayInfo>& arrays) {
  constexpr int kMostListed = 16;  // components of one array: a tensor has 9
  std::vector<ScalarChoice> single;
  std::vector<ScalarChoice> magnitudes;
  std::vector<ScalarChoice> components;
  for (const ArrayInfo& array : arrays) {
    if (array.components == 1) {
      single.push_back({array.name, array.association, 0});
      continue;
    }
    magnitudes.push_back({array.name, array.association, ScalarChoice::kMagnitude});
    for (int c = 0; c < std::min(array.components, kMostListed); ++c)
      components.push_back({array.name, array.association, c});
  }
  const auto on_cells = [](const ScalarChoice& choice) { return choice.association == Association::kCell; };
  // What numbers regions is a result only where there is no other.
  std::stable_partition(single.begin(), single.end(), [&](const ScalarChoice& choice) {
    return !(on_cells(choice) && numbers_regions(choice.array));
  });
  std::vector<ScalarChoice> all;
  for (auto* part : {&single, &magnitudes, &components}) {
    std::stable_partition(part->begin(), part->end(), [&](const auto& choice) { return !on_cells(choice); });
    all.insert(all.end(), part->begin(), part->end());
  }
  return all;
}

ScalarChoice choose_scalar(const std::vector<ArrayInfo>& arrays, std::string_view requested,
                           const std::string& file) {
  const std::vector<ScalarChoice> choices = scalar_choices(arrays);
  if (choices.empty())
    throw input_error({file, "", "has no array of numbers", "a scalar at points or cells", ""});
  if (requested.empty()) return choices.front();
  std::string known;
  for (const ScalarChoice& choice : choices) {
    const std::string label = label_of(choice, arrays);
    const bool whole = choice.component == ScalarChoice::kMagnitude && requested == choice.array;
    if (label == requested || whole) return choice;
    known += (known.empty() ? "" : ", ") + label;
  }
  throw usage_error("there is no scalar " + std::string(requested) + ": " + file + " has " + known);
}

}  // namespace palpate
