/// Sampling an EX model into cells.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "common/field/data_set.h"
#include "loaders/cardiac/ex/ex_model.h"

namespace palpate::ex {

/// A sampled model, and what is to be said of it.
struct SampledModel {
  /// Hexahedra with their corners in VTK's order; those at collapsed edges name a point twice or more. Of simplices
  /// tetrahedra and wedges (ex_places.h), linear ones as they stand; these have no third axis that runs through the wall,
  /// and so no "surface" and "layer".
  /// Point arrays "fibre", "sheet", "normal" (unit vectors; NaN where an edge is collapsed), "fibre angle",
  /// "imbrication angle", "sheet angle" [degrees], "surface" (1 where the third axis of an element begins at
  /// the border, the inner surface; 2 where it ends there; else 0), "layer" (layer_levels(), where it rises
  /// from 0 to 1 everywhere); cell array
  /// "element" (its number in the file). Other fields of numbers are point arrays of their own name
  /// (ex_fields.h); at points where elements disagree that of the first one is kept. Models without a fibre field have no axes and angles.
  DataSet mesh;
  std::vector<std::string> notes;
};

/// The layer of elements that each element is in, from 0, where the third axis runs through the wall: one
/// more than the element that it stands on, the same as those beside it, the lowest of each connected part at
/// 0. The depth (level + xi_3) / levels then has no jump between elements. Empty where no such numbers exist.
[[nodiscard]] std::vector<int> layer_levels(const std::vector<std::array<std::int64_t, 8>>& corners);

/// Samples every element at (refine + 1)^3 places, of simplices a part of these, equidistant in xi. Places of neighbouring elements that
/// differ by less than 1e-9 of the model's size are one point; where elements disagree there on an angle
/// (versions), the first one's is kept, and said.
/// @param memory in bytes that samples, and the tetrahedra made of them, may take.
/// @throws Error (bad input) naming `file`: no element, no coordinates, parameters that are missing, more
/// samples than the memory holds.
[[nodiscard]] SampledModel sample(const Model& model, int refine, const std::string& file,
                                  std::uint64_t memory = std::numeric_limits<std::uint64_t>::max());

/// The volume of the model by Gauss-Legendre quadrature of `order` points along each axis of every element,
/// in the cube of its unit. @throws as sample().
[[nodiscard]] double exact_volume(const Model& model, int order, const std::string& file);

/// From apex to base, where the model's coordinates are prolate spheroidal in all elements: their axis runs
/// to the apex (mu = 0) along x. Nothing in other systems.
[[nodiscard]] std::optional<Vec3> long_axis(const Model& model);

}  // namespace palpate::ex
