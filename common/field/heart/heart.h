/// The muscle of a heart as a field: fibres, sheets and layers on one tetrahedral mesh.
///
/// Directions have no sign: what is interpolated are the components of their outer products, and a direction
/// is the major eigenvector of that (Ikits 2006, sec. 8.2). Directions of cells are brought to the points as
/// outer products, too (their volume-weighted mean), so that signs leave no trace there either; or they hold
/// all over their cell, as they were given.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/field/data_set.h"
#include "common/field/layer/wall_layer.h"
#include "common/field/scalar_field.h"
#include "common/field/tensor/tensor_field.h"
#include "common/field/vector_choice.h"

namespace palpate {

/// A direction array.
struct DirectionChoice {
  std::string array;
  Association association = Association::kPoint;
};

/// Which arrays make a heart.
struct HeartChoice {
  DirectionChoice fibre;
  DirectionChoice sheet;  ///< no array: none is known
  std::string layer;      ///< point array that rises through the wall; empty: from Laplace's equation
  bool surface = false;   ///< the file says which points lie on the inner and the outer surface
  std::vector<SurfacePaint> paint;  ///< of its surfaces; layers of the file count no more where there is some
  bool constant_cells = false;      ///< directions of cells hold all over their cell: TensorChoice

  /// All that are to be read.
  [[nodiscard]] std::vector<std::string> arrays() const;
};

/// Every array that may hold fibres, the one to be taken by default first: three components; names that
/// mean fibres before others, points before cells, then file order. "sheet" and "normal" are none.
[[nodiscard]] std::vector<DirectionChoice> fibre_choices(const std::vector<ArrayInfo>& arrays);

/// @param fibre name of the fibres' array; empty: the default one.
/// @throws Error (usage) naming the known ones, or (bad input) with `file` where there is none.
[[nodiscard]] HeartChoice choose_heart(const std::vector<ArrayInfo>& arrays, std::string_view fibre,
                                       const std::string& file);

struct Heart {
  std::shared_ptr<const TensorField> fibres;
  std::shared_ptr<const TensorField> sheets;  ///< null: not known
  std::shared_ptr<const ScalarField> layer;   ///< depth s, named kLayerArray; null: none, or not solved
  std::string no_layers;                      ///< why none can be made; empty: they can
  std::shared_ptr<const ScalarField> value;  ///< a potential, an activation time: what else is shown; or null
  std::optional<Vec3> axis;                  ///< from apex to base, where the file says it; data coordinates
  std::vector<std::string> notes;            ///< of mesh, fibres and layers, for the user
  std::vector<double> regions_left_out;      ///< as they have no fibres
};

/// What becomes of a heart without layers: they are solved, and where they cannot be that is an error, or the
/// Heart says why; or their surfaces alone are found, which takes little time, where they are not kept.
enum class LayersNeeded : std::uint8_t { kAlways, kIfPossible, kSurfaces };

/// Points at the very same place count as one (heart.h).
/// @param kept where layers are looked for before they are solved, and kept when they were; null: nowhere.
/// @throws Error (bad input) with `file` for images (a heart is a mesh), meshes without a volume, and as
/// make_field_grid(); where layers are needed also for meshes without an inner and an outer surface that come
/// without layers, and (work failed) as make_wall_layer().
[[nodiscard]] Heart make_heart(const DataSet& mesh, const HeartChoice& choice, const std::string& file,
                               int threads = 0, LayersNeeded layers = LayersNeeded::kAlways,
                               CachedLayers* kept = nullptr);

/// Lets the cells of an unstructured mesh name the first of all points at one place (equal coordinates, to
/// the last bit); the others stay, without a cell. Other topologies are left as they are.
/// @return how many points are named no more.
std::size_t join_same_points(DataSet& mesh);

}  // namespace palpate
