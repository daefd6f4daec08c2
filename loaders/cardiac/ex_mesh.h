/// Sampling an EX model into hexahedra.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/field/data_set.h"
#include "loaders/cardiac/ex_model.h"

namespace palpate::ex {

/// A sampled model, and what is to be said of it.
struct SampledModel {
  /// Hexahedra with their corners in VTK's order; those at collapsed edges name a point twice or more.
  /// Point arrays "fibre", "sheet", "normal" (unit vectors; NaN where an edge is collapsed), "fibre angle",
  /// "imbrication angle", "sheet angle" [degrees], "surface" (1 where the third axis of an element begins at
  /// the border, the inner surface; 2 where it ends there; else 0); cell array "element" (its number in the
  /// file). Models without a fibre field have no axes and angles.
  DataSet mesh;
  std::vector<std::string> notes;
};

/// Samples every element at (refine + 1)^3 places, equidistant in xi. Places of neighbouring elements that
/// differ by less than 1e-9 of the model's size are one point; where elements disagree there on an angle
/// (versions), the first one's is kept, and said.
/// @throws Error (bad input) naming `file`: no element, no coordinates, parameters that are missing.
[[nodiscard]] SampledModel sample(const Model& model, int refine, const std::string& file);

/// The volume of the model by Gauss-Legendre quadrature of `order` points along each axis of every element,
/// in the cube of its unit. @throws as sample().
[[nodiscard]] double exact_volume(const Model& model, int order, const std::string& file);

}  // namespace palpate::ex
