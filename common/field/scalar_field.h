/// A scalar field on the grid of a vector field: a component or the magnitude of any point or cell array,
/// to colour lines and volumes by.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "common/field/data_set.h"
#include "common/field/sample.h"
#include "common/field/vector_field.h"

namespace palpate {

/// Which number of an array's tuples.
struct ScalarChoice {
  std::string array;
  Association association = Association::kPoint;
  int component = 0;  ///< or kMagnitude
  static constexpr int kMagnitude = -1;
};

/// Immutable; values are in data units, stored as read (single precision unless the array is double).
class ScalarField {
 public:
  /// Samples at `x` in data coordinates: trilinear or linear, as the vector field. @rt Safe.
  [[nodiscard]] ScalarSample sample(const Vec3& x_data, CellHint& hint) const noexcept;
  /// Gradient of the interpolant, value units per length unit; status as sample. @rt Safe.
  [[nodiscard]] VectorSample gradient(const Vec3& x_data, CellHint& hint) const noexcept;

  [[nodiscard]] const std::string& name() const noexcept { return name_; }
  [[nodiscard]] double lowest() const noexcept { return lowest_; }  ///< of the finite values
  [[nodiscard]] double highest() const noexcept {
    return highest_;
  }  ///< lowest > highest where there are none

 private:
  friend std::shared_ptr<const ScalarField> make_scalar_field(const VectorField&, const std::vector<DataSet>&,
                                                              const ScalarChoice&, const std::string&, int);
  std::string name_;
  std::shared_ptr<const FieldGrid> grid_;
  std::variant<std::span<const float>, std::span<const double>> values_;
  std::shared_ptr<const void> owner_;
  double lowest_ = 0.0;
  double highest_ = -1.0;
};

/// Makes the field that `choice` describes on the grid of `like`. `blocks` are those that `like` was made
/// from, perhaps with other arrays. Blocks without the array have no values: bad data there.
/// @throws Error (bad input) with `file` where no block has the array or its shape is wrong; (usage) where
/// `like` is a formula or the component does not exist.
[[nodiscard]] std::shared_ptr<const ScalarField> make_scalar_field(const VectorField& like,
                                                                   const std::vector<DataSet>& blocks,
                                                                   const ScalarChoice& choice,
                                                                   const std::string& file, int threads = 0);

}  // namespace palpate
