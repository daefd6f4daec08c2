#include "common/field/heart/tissue.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <span>
#include <variant>

#include "common/base/index.h"
#include "common/base/text.h"
#include "common/field/grid/cell_faces.h"
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

/// Says which regions have one direction in all their elements, while those of others turn: programs that need a
/// direction everywhere give bath and blood such a one.
/// @param shown cells of the wall.
void note_even_regions(const std::vector<bool>& shown, const DataArray& fibre, const DataArray& numbers,
                       std::vector<std::string>& notes) {
  constexpr double kEven = 1.0 - 1e-9;  // cosine
  constexpr std::size_t kFew = 10;      // elements, which may be alike by chance
  struct Directions {
    Vec3 first{0.0};
    std::size_t count = 0;
    bool even = true;
  };
  std::map<double, Directions> regions;
  for (std::size_t c = 0; c < fibre.tuples; ++c) {
    const Vec3 d{fibre.at(c, 0), fibre.at(c, 1), fibre.at(c, 2)};
    const double length = glm::length(d);
    if (!shown[c] || !(length > 0.0) || !std::isfinite(length)) continue;
    Directions& region = regions[numbers.at(c)];
    if (region.count++ == 0) region.first = d / length;
    region.even = region.even && std::abs(glm::dot(d / length, region.first)) > kEven;
  }
  if (std::all_of(regions.begin(), regions.end(), [](const auto& r) { return r.second.even; })) return;
  for (const auto& [number, region] : regions)
    if (region.even && region.count > kFew)
      notes.push_back("WARNING: all " + counted(region.count, "direction") + " of region " +
                      short_number(number) + " are (" + short_number(region.first.x) + ", " +
                      short_number(region.first.y) + ", " + short_number(region.first.z) +
                      "), while those of others turn: is it bath or blood? --regions leaves it out");
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

Tissue hide_all_but_tissue(DataSet& mesh, const DirectionChoice& choice) {
  Tissue tissue;
  std::vector<std::string>& notes = tissue.notes;
  drop_tiny_directions(mesh, choice, notes);
  const auto* const cells = std::get_if<UnstructuredTopology>(&mesh.topology);
  const DataArray* const fibre = mesh.find(choice.array, choice.association);
  if (cells == nullptr || fibre == nullptr || !fit(*cells, *fibre)) return tissue;
  const std::vector<bool> without = cells_without(*cells, *fibre);
  mesh.hidden_cells.resize(without.size());
  // Triangles on the border are no part of the wall, whatever region and direction they have.
  std::vector<bool> of_wall(without.size());
  for (std::size_t c = 0; c < of_wall.size(); ++c)
    of_wall[c] = mesh.hidden_cells[c] == 0 && !is_flat(cells->types[c]);
  const auto shown = [&of_wall](std::size_t c) { return of_wall[c]; };
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
  if (tell && regions.size() > 1 && fibre->association == Association::kCell)
    note_even_regions(of_wall, *fibre, *numbers, notes);
  std::string names;
  std::size_t hidden = 0;
  for (const auto& [number, region] : regions) {
    if (!tell || !region.bare()) continue;
    names += (names.empty() ? "" : ", ") + short_number(number);
    tissue.left_out.push_back(number);
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
    return tissue;
  }
  std::size_t all = 0, bare = 0;
  for (std::size_t c = 0; c < without.size(); ++c) {
    all += shown(c) ? 1 : 0;
    bare += shown(c) && without[c] ? 1 : 0;
  }
  if (std::ranges::count(mesh.hidden_cells, std::uint8_t{0}) == std::ssize(mesh.hidden_cells))
    mesh.hidden_cells.clear();
  const double share = static_cast<double>(bare) / static_cast<double>(std::max<std::size_t>(1, all));
  if (share > kManyWithout && bare < all)
    notes.push_back("WARNING: " + counted(bare, "element") + " of " + std::to_string(all) +
                    " without a fibre, and no region that tells bath or blood from muscle: layers go through "
                    "them all; number regions in an array 'region' of elements");
  return tissue;
}

}  // namespace palpate
