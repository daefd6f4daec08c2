/// Which array makes a scalar field, and which number of its tuples.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "common/field/scalar_field.h"
#include "common/field/vector_choice.h"

namespace palpate {

/// One number of a tuple: a component, or the Euclidean norm for ScalarChoice::kMagnitude.
/// @pre tuple < array.tuples, component < array.components.
[[nodiscard]] double number_of(const DataArray& array, std::size_t tuple, int component) noexcept;

/// "density" for an array of one component; "velocity:magnitude", "velocity:0" for those of several.
[[nodiscard]] std::string label_of(const ScalarChoice& choice, const std::vector<ArrayInfo>& arrays);

/// Every scalar that can be taken, the one to be taken by default first. The rule: arrays of one component
/// before magnitudes before components, points before cells, then file order.
[[nodiscard]] std::vector<ScalarChoice> scalar_choices(const std::vector<ArrayInfo>& arrays);

/// The choice whose label is `requested` (the default one where it is empty); the bare name of an array of
/// several components means its magnitude.
/// @throws Error (usage) naming the known ones, or (bad input) where the file holds no array.
[[nodiscard]] ScalarChoice choose_scalar(const std::vector<ArrayInfo>& arrays, std::string_view requested,
                                         const std::string& file);

}  // namespace palpate
