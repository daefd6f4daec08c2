#include "common/field/heart/tissue.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <span>
#include <variant>

#include "common/base/index.h"
#include "common/base/text.h"
#include "common/field/heart/regions.h"
#include "common/field/region_names.h"

namespace palpate {
namespace {

constexpr double kMostWithout = 0.95;  // of a region's elements
constexpr double kManyWithout = 0.2;   // of all elements

/// What does not fit is refused where fields are made.
bool fit(const UnstructuredTopology& cells, const DataArray& fibre) {
  const bool of_cells = fibre.association == Association::kCell;
  return fibre.components == 3 && fibre.tuples == (of_cells ? cells.types.size() : cells.positions.tuples) &&
         cells.offsets.size() == cells.types.size() + 1 &&
         std::is_sorted(cells.offsets.begin(), cells.offsets.end()) && cells.offsets.front() >= 0 &&
         as_size(cells.offsets.back()) <= cells.connectivity.size();
}

/// Whether each cell lacks a direction, or one of its points does.
std::vector<bool> cells_without(const UnstructuredTopology& cells, const DataArray& fibre) {
  std::vector<bool> lacks(fibre.tuples);
  for (std::size_t i = 0; i < fibre.tuples; ++i) {
    const double length = std::hypot(fibre.at(i, 0), fibre.at(i, 1), fibre.at(i, 2));
    lacks[i] = !(length > 0.0) || !std::isfinite(length);
  }
  if (fibre.association == Association::kCell) return lacks;
  std::vector<bool> without(cells.types.size());
  for (std::size_t c = 0; c < without.size(); ++c)
    for (std::int64_t i = cells.offsets[c]; i < cells.offsets[c + 1]; ++i) {
      const std::int64_t p = cells.connectivity[as_size(i)];
      // What names no point is refused where cells are split.
      if (p >= 0 && as_size(p) < lacks.size() && lacks[as_size(p)]) without[c] = true;
    }
  return without;
}

const DataArray* regions_of(const DataSet& mesh) {
  for (const DataArray& array : mesh.arrays)
    if (array.association == Association::kCell && array.components == 1 && numbers_regions(array.name))
      return &array;
  return nullptr;
}

struct Region {
  std::size_t elements = 0, without = 0;
  [[nodiscard]] bool bare() const {
    return static_cast<double>(without) > kMostWithout * static_cast<double>(elements);
  }
};

/// Takes directions that are next to nothing for none, and says so.
void drop_tiny_directions(DataSet& mesh, const DirectionChoice& choice, std::vector<std::string>& notes) {
  const DataArray* const fibre = mesh.find(choice.array, choice.association);
  if (fibre == nullptr || fibre->components != 3) return;
  std::vector<double> values(3 * fibre->tuples), lengths(fibre->tuples);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = fibre->at(i / 3, static_cast<int>(i % 3));
  for (std::size_t i = 0; i < lengths.size(); ++i)
    lengths[i] = std::hypot(values[3 * i], values[3 * i + 1], values[3 * i + 2]);
  const double least = least_direction_length(lengths);
  std::size_t tiny = 0;
  for (std::size_t i = 0; i < fibre->tuples; ++i) {
    if (!(lengths[i] > 0.0) || !(lengths[i] < least)) continue;
    std::fill_n(values.begin() + static_cast<std::ptrdiff_t>(3 * i), 3, 0.0);
    ++tiny;
  }
  if (tiny == 0) return;
  const std::string name = fibre->name;
  const auto at = std::find_if(mesh.arrays.begin(), mesh.arrays.end(),
                               [fibre](const DataArray& array) { return &array == fibre; });
  *at = make_array(name, choice.association, 3, std::span<const double>(values));
  notes.push_back(counted(tiny, "direction") + " of '" + name +
                  "' a million times shorter than the others: taken for none");
}

}  // namespace

double least_direction_length(std::span<const double> lengths) {
  constexpr double kTiny = 1e-6, kUsual = 0.95;
  std::vector<double> known;
  for (const double length : lengths)
    if (length > 0.0 && std::isfinite(length)) known.push_back(length);
  if (known.empty()) return 0.0;
  const auto usual =
      known.begin() + static_cast<std::ptrdiff_t>(std::ceil(kUsual * static_cast<double>(known.size() - 1)));
  std::nth_element(known.begin(), usual, known.end());
  return kTiny * *usual;
}

std::string region_array(const std::vector<ArrayInfo>& arrays) {
  for (const ArrayInfo& array : arrays)
    if (array.association == Association::kCell && array.components == 1 && numbers_regions(array.name))
      return array.name;
  return {};
}

std::vector<std::string> hide_all_but_tissue(DataSet& mesh, const DirectionChoice& choice) {
  std::vector<std::string> notes;
  drop_tiny_directions(mesh, choice, notes);
  const auto* const cells = std::get_if<UnstructuredTopology>(&mesh.topology);
  const DataArray* const fibre = mesh.find(choice.array, choice.association);
  if (cells == nullptr || fibre == nullptr || !fit(*cells, *fibre)) return notes;
  const std::vector<bool> without = cells_without(*cells, *fibre);
  mesh.hidden_cells.resize(without.size());
  const auto shown = [&mesh](std::size_t c) { return mesh.hidden_cells[c] == 0; };
  const DataArray* numbers = regions_of(mesh);
  if (numbers != nullptr && numbers->tuples != without.size()) numbers = nullptr;
  std::map<double, Region> regions;
  for (std::size_t c = 0; numbers != nullptr && c < without.size() && regions.size() <= kMostHeartRegions;
       ++c) {
    if (!shown(c)) continue;
    const double number = numbers->at(c);
    Region& region = regions[std::isfinite(number) ? number : 0.0];
    ++region.elements;
    region.without += without[c] ? 1 : 0;
  }
  const bool tell =
      regions.size() <= kMostHeartRegions &&
      std::any_of(regions.begin(), regions.end(), [](const auto& r) { return !r.second.bare(); });
  std::string names;
  std::size_t hidden = 0;
  for (const auto& [number, region] : regions) {
    if (!tell || !region.bare()) continue;
    names += (names.empty() ? "" : ", ") + short_number(number);
    hidden += region.elements;
  }
  if (hidden > 0) {
    std::size_t left_fibres = 0;
    for (std::size_t c = 0; c < without.size(); ++c) {
      if (!shown(c)) continue;
      const double number = numbers->at(c);
      if (!regions.at(std::isfinite(number) ? number : 0.0).bare()) continue;
      mesh.hidden_cells[c] = 1;
      left_fibres += without[c] ? 0 : 1;
    }
    notes.push_back("region " + names + " of '" + numbers->name + "' left out, as it has no fibres: " +
                    counted(hidden, "element") + " of " + std::to_string(without.size()) +
                    (left_fibres > 0 ? ", of which " + std::to_string(left_fibres) + " have one" : "") +
                    "; muscle is where fibres are");
    return notes;
  }
  std::size_t all = 0, bare = 0;
  for (std::size_t c = 0; c < without.size(); ++c) {
    all += shown(c) ? 1 : 0;
    bare += shown(c) && without[c] ? 1 : 0;
  }
  if (all == without.size()) mesh.hidden_cells.clear();
  const double share = static_cast<double>(bare) / static_cast<double>(std::max<std::size_t>(1, all));
  if (share > kManyWithout && bare < all)
    notes.push_back("WARNING: " + counted(bare, "element") + " of " + std::to_string(all) +
                    " without a fibre, and no region that tells bath or blood from muscle: layers go through "
                    "them all; number regions in an array 'region' of elements");
  return notes;
}

}  // namespace palpate
