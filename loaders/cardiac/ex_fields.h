/// Fields of an EX model beside its coordinates and fibres: pressures, strains, activation times.
#pragma once

#include <string>
#include <vector>

#include "loaders/cardiac/ex_element.h"
#include "loaders/cardiac/ex_model.h"

namespace palpate::ex {

/// A field that all elements have.
struct OtherField {
  std::string name;
  int components = 1;
  std::vector<ElementValues> of_element;  ///< of each element of the model
};

/// All of them but "coordinates", "fibres" and `coordinates`: those that not every element has, that are
/// not Cartesian, or whose parameters are not all there, are left out, and `notes` say so.
/// @pre every element has fields.
[[nodiscard]] std::vector<OtherField> other_fields(const Model& model, const std::string& file,
                                                   std::vector<std::string>& notes);

}  // namespace palpate::ex
