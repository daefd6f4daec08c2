#include "common/field/heart/heart.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "common/base/clock.h"
#include "common/base/error.h"
#include "common/base/index.h"
#include "common/base/text.h"
#include "common/field/cells/same_place.h"
#include "common/field/field_grid.h"
#include "common/field/field_on_grid.h"
#include "common/field/grid/mesh_quality.h"
#include "common/field/heart/tissue.h"
#include "common/field/layer/paint_surfaces.h"
#include "common/field/layer/wall_measures.h"
#include "common/field/layer/wall_surfaces.h"

namespace palpate {
namespace {

constexpr std::uint8_t kVtkPolyhedron = 42;

bool means(const std::string& name, std::string_view word) {
  return lowered(name).find(word) != std::string::npos;
}

bool means_other(const std::string& name) {
  return means(name, "sheet") || means(name, "normal") || lowered(name) == "s0" || lowered(name) == "n0";
}

bool is_direction(const ArrayInfo& array) {
  return array.components == 3 && (array.type == ScalarType::kFloat32 || array.type == ScalarType::kFloat64);
}

const char* note_on_directions(const TensorField& fibres, const HeartChoice& choice) {
  if (fibres.constant_in_cells())
    return "directions of cells hold all over their cell: fibres turn at its faces, where lines lose their "
           "order "
           "of accuracy; at points volume-weighted mean of their outer products";
  if (choice.fibre.association == Association::kCell)
    return "directions of cells brought to the points: volume-weighted mean of their outer products";
  return choice.constant_cells
             ? "directions of points interpolated: there are none of cells to be constant in"
             : "directions of points interpolated by their outer products";
}

/// Says where sheets are not perpendicular to fibres.
void note_on_sheets(const DataSet& mesh, const HeartChoice& choice, std::vector<std::string>& notes) {
  constexpr double kSkew = 0.0871557427;  // sine of 5 degrees
  const DataArray* const fibre = mesh.find(choice.fibre.array, choice.fibre.association);
  const DataArray* const sheet = mesh.find(choice.sheet.array, choice.fibre.association);
  if (fibre == nullptr || sheet == nullptr || fibre->tuples != sheet->tuples) return;
  std::size_t skew = 0;
  double most = 0.0;
  for (std::size_t i = 0; i < fibre->tuples; ++i) {
    const Vec3 f{fibre->at(i, 0), fibre->at(i, 1), fibre->at(i, 2)};
    const Vec3 s{sheet->at(i, 0), sheet->at(i, 1), sheet->at(i, 2)};
    const double sine = std::abs(glm::dot(f, s)) / (glm::length(f) * glm::length(s));
    if (!(sine > kSkew)) continue;  // nor where one of them is none
    ++skew;
    most = std::max(most, sine);
  }
  if (skew > 0)
    notes.push_back("WARNING: " + counted(skew, "sheet") + " of '" + sheet->name + "' up to " +
                    short_number(std::round(std::asin(std::min(most, 1.0)) * 180.0 / std::numbers::pi)) +
                    " degrees off a right angle to the fibre: taken as they stand");
}

/// Those of the file, or Laplace's. @throws Error as make_heart() where there are none.
void add_layers(const std::shared_ptr<const FieldGrid>& grid, const DataSet& mesh, const HeartChoice& choice,
                const std::string& file, int threads, LayersNeeded layers, CachedLayers* kept, Heart& heart) {
  if (!choice.layer.empty() && choice.paint.empty()) {
    heart.layer = make_scalar_field(grid, mesh, {.array = choice.layer}, file, threads);
    heart.notes.push_back("layers from the array '" + choice.layer + "'");
    const DataArray* const depth = mesh.find(choice.layer, Association::kPoint);
    if (std::string doubt = inward_doubt(*grid, *depth); !doubt.empty())
      heart.notes.push_back(std::move(doubt));
  } else {
    if (!choice.paint.empty()) kept = nullptr;  // what is kept knows nothing of paint
    std::optional<WallLayer> layer = kept != nullptr ? kept->find(mesh) : std::nullopt;
    if (!layer && layers == LayersNeeded::kSurfaces) {
      const std::vector<std::string> found = notes_of(find_painted_surfaces(*grid, mesh, file, choice.paint));
      heart.notes.emplace_back(
          "layers by Laplace's equation from the inner to the outer surface, solved when they are needed");
      heart.notes.insert(heart.notes.end(), found.begin(), found.end());
      return;
    }
    if (!layer) {
      const Stopwatch watch;
      layer = make_wall_layer(*grid, mesh, file, threads, choice.paint);
      if (kept != nullptr) kept->keep(mesh, *layer, watch.seconds());
    }
    DataSet with = mesh;
    with.arrays = {std::move(layer->array)};
    heart.layer = make_scalar_field(grid, with, {.array = kLayerArray}, file, threads);
    heart.notes.emplace_back("layers by Laplace's equation from the inner to the outer surface");
    heart.notes.insert(heart.notes.end(), layer->notes.begin(), layer->notes.end());
  }
  if (!(heart.layer->local_range() > 0.0))
    throw input_error({file, "", "has layers that are all the same", "a depth that rises through the wall"});
}

}  // namespace

bool means_fibre(const std::string& name) {
  const std::string low = lowered(name);
  return means(name, "fibre") || means(name, "fiber") || low == "f" || low == "f0" || low.ends_with("_f0");
}

std::size_t join_same_points(DataSet& mesh) {
  auto* cells = std::get_if<UnstructuredTopology>(&mesh.topology);
  if (cells == nullptr || cells->positions.components != 3) return 0;
  // The streams of polyhedra hold counts between their points.
  if (std::find(cells->types.begin(), cells->types.end(), kVtkPolyhedron) != cells->types.end()) return 0;
  const std::vector<std::int64_t> first = first_at_place(cells->positions);
  std::vector<std::uint8_t> joined(first.size(), 0);
  for (std::int64_t& p : cells->connectivity) {
    // What names no point is refused where cells are split.
    if (p < 0 || as_size(p) >= first.size()) continue;
    const std::int64_t of = first[as_size(p)];
    if (of != p) joined[as_size(p)] = 1;
    p = of;
  }
  return as_size(std::count(joined.begin(), joined.end(), std::uint8_t{1}));
}

std::vector<std::string> HeartChoice::arrays() const {
  std::vector<std::string> names{fibre.array};
  if (!sheet.array.empty()) names.push_back(sheet.array);
  if (!layer.empty()) names.push_back(layer);
  if (layer.empty() && surface) names.emplace_back(kSurfaceArray);
  return names;
}

std::vector<DirectionChoice> fibre_choices(const std::vector<ArrayInfo>& arrays) {
  std::vector<const ArrayInfo*> found;
  for (const ArrayInfo& array : arrays)
    if (is_direction(array) && !means_other(array.name)) found.push_back(&array);
  const auto rank = [](const ArrayInfo* array) {
    return (means_fibre(array->name) ? 0 : 2) + (array->association == Association::kPoint ? 0 : 1);
  };
  std::stable_sort(found.begin(), found.end(),
                   [&](const ArrayInfo* a, const ArrayInfo* b) { return rank(a) < rank(b); });
  std::vector<DirectionChoice> choices;
  choices.reserve(found.size());
  for (const ArrayInfo* array : found) choices.push_back({array->name, array->association});
  return choices;
}

HeartChoice choose_heart(const std::vector<ArrayInfo>& arrays, std::string_view fibre,
                         const std::string& file) {
  const std::vector<DirectionChoice> choices = fibre_choices(arrays);
  if (choices.empty()) {
    throw input_error(
        {file, "", "has no fibres", "an array of three numbers a point or cell",
         "fibres come with EX and openCARP models, .ortho, .axi and .bases files, or as an array 'fibre'"});
  }
  HeartChoice choice{.fibre = choices.front()};
  if (!fibre.empty()) {
    const auto named = std::find_if(choices.begin(), choices.end(),
                                    [&](const DirectionChoice& each) { return each.array == fibre; });
    if (named == choices.end()) {
      std::string known;
      for (const DirectionChoice& each : choices) known += (known.empty() ? "" : ", ") + each.array;
      throw usage_error("--field " + std::string(fibre) + ": " + file + " has " + known);
    }
    choice.fibre = *named;
  }
  for (const ArrayInfo& array : arrays) {
    const bool scalar = array.components == 1 && array.association == Association::kPoint;
    if (is_direction(array) && means(array.name, "sheet") && !means(array.name, "normal") &&
        choice.sheet.array.empty())
      choice.sheet = {array.name, array.association};
    if (scalar && array.name == kLayerArray) choice.layer = kLayerArray;
    if (scalar && array.name == kSurfaceArray) choice.surface = true;
  }
  return choice;
}

Heart make_heart(const DataSet& given, const HeartChoice& choice, const std::string& file, int threads,
                 LayersNeeded layers, CachedLayers* kept) {
  DataSet mesh = given;
  const std::size_t joined = join_same_points(mesh);
  const Tissue tissue = hide_all_but_tissue(mesh, choice.fibre);
  const auto grid = make_field_grid(std::span(&mesh, 1), file, threads);
  if (!grid->tets) {
    throw input_error(
        {file, "", "is an image of voxels", "a mesh of the heart's wall", "open it as tensors"});
  }
  if (grid->tets->zero_volume_count() == grid->tets->cells().size())
    throw input_error({file, "", "has no cell with a volume", "tetrahedra that fill the wall"});
  const auto directions = [&](const DirectionChoice& from) {
    return make_tensor_field(grid, mesh,
                             {.array = from.array,
                              .order = TensorOrder::kAxis,
                              .association = from.association,
                              .constant_cells = choice.constant_cells},
                             file, threads);
  };
  Heart heart;
  heart.fibres = directions(choice.fibre);
  heart.notes = tissue.notes;
  heart.regions_left_out = tissue.left_out;
  const std::vector<std::string>& of_fibres = heart.fibres->notes().lines;
  heart.notes.insert(heart.notes.end(), of_fibres.begin(), of_fibres.end());
  if (const std::size_t folded = folded_faces(*grid->tets); folded > 0)
    heart.notes.push_back(
        counted(folded, "face") +
        " with both tetrahedra on one side: these overlap, and a place in both belongs to either");
  if (joined > 0) heart.notes.push_back(counted(joined, "point") + " at the place of another one: joined");
  heart.notes.emplace_back(note_on_directions(*heart.fibres, choice));
  if (!choice.sheet.array.empty()) {
    heart.sheets = directions(choice.sheet);
    note_on_sheets(mesh, choice, heart.notes);
  }
  try {
    add_layers(grid, mesh, choice, file, threads, layers, kept, heart);
  } catch (const Error& error) {
    if (layers == LayersNeeded::kAlways || error.code() == ExitCode::kInterrupted) throw;
    heart.layer = nullptr;
    heart.no_layers = error.what();
  }
  return heart;
}

}  // namespace palpate
