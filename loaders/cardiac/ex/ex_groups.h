/// Surfaces of a wall that groups of an EX model name.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "loaders/cardiac/ex/ex_model.h"
#include "loaders/cardiac/ex/ex_places.h"

namespace palpate::ex {

/// Where the elements of a model are sampled.
struct SampledPlaces {
  const std::vector<const ElementPlaces*>& of_element;
  const std::vector<std::size_t>& first;      ///< place of each element
  const std::vector<std::int64_t>& point_of;  ///< of each place
  std::size_t points = 0;
};

/// The array "surface" (wall_surfaces.h) by groups whose names have "endo" (with "right" or "rv": the right one's) or "epi":
/// of the faces that they list, or whose nodes they list all. Empty where there are not both, or elements are no cubes.
/// @param notes gets which groups were taken.
[[nodiscard]] std::vector<double> group_surfaces(const Model& model, const SampledPlaces& places,
                                                 std::vector<std::string>& notes);

}  // namespace palpate::ex
