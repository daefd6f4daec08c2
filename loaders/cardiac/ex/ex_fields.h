/// Fields of an EX model beside its coordinates and fibres: pressures, strains, activation times.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/field/data_set.h"
#include "loaders/cardiac/ex/ex_element.h"
#include "loaders/cardiac/ex/ex_model.h"

namespace palpate::ex {

/// A field, and its values at the points of a sampling.
class OtherField {
 public:
  /// @param of_element of each element of the model; nothing where that has no such field.
  OtherField(std::string name, int components, std::vector<std::optional<ElementValues>> of_element)
      : name_(std::move(name)), components_(components), of_element_(std::move(of_element)) {}

  [[nodiscard]] const std::string& name() const noexcept { return name_; }
  [[nodiscard]] int components() const noexcept { return components_; }
  /// Whether each element has one value of its own: an array of cells.
  [[nodiscard]] bool of_cells() const;

  /// The values of the next point, as `element` has them.
  void append(std::size_t element, const Vec3& xi);
  /// What another element has at point `at`: taken where the first one had none.
  void join(std::size_t at, std::size_t element, const Vec3& xi);
  [[nodiscard]] const std::vector<double>& values() const noexcept { return values_; }
  /// Of an element. @pre of_cells()
  [[nodiscard]] std::vector<double> values_of(std::size_t element) const {
    return values_at(element, Vec3{0.0});
  }
  /// How many points have other values in other elements.
  [[nodiscard]] std::size_t disagreeing() const;

 private:
  [[nodiscard]] std::vector<double> values_at(std::size_t element, const Vec3& xi) const;

  std::string name_;
  int components_;
  std::vector<std::optional<ElementValues>> of_element_;
  std::vector<double> values_;
  std::map<std::size_t, double> apart_;  ///< largest difference at a point
};

/// All of them but "coordinates", "fibres" and `coordinates`. `notes` say which elements have no data of a field, and why;
/// what no element has, and fields of nodes that no element interpolates, are left out, and said.
/// @param refine cells along each axis of an element: what grids have more than these show is said.
/// @pre every element has fields.
[[nodiscard]] std::vector<OtherField> other_fields(const Model& model, int refine, const std::string& file,
                                                   std::vector<std::string>& notes);

/// Appends the fields as arrays of `mesh`, of another name where theirs has a meaning or is taken; `notes` say at how many
/// points elements disagree. @param element_of of each cell.
void add_arrays(const std::vector<OtherField>& others, const std::vector<std::size_t>& element_of,
                DataSet& mesh, std::vector<std::string>& notes);

}  // namespace palpate::ex
