/// Fields on a grid that is there already, so that several share one.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "common/field/field_grid.h"
#include "common/field/scalar_field.h"
#include "common/field/tensor/tensor_field.h"
#include "common/field/vector_field.h"

namespace palpate {

/// Makes the field that `choice` describes on `grid`, which was made of `block`, perhaps with other arrays.
/// @throws Error as make_scalar_field().
[[nodiscard]] std::shared_ptr<const ScalarField> make_scalar_field(std::shared_ptr<const FieldGrid> grid,
                                                                   const DataSet& block,
                                                                   const ScalarChoice& choice,
                                                                   const std::string& file, int threads = 0);

/// The same of vectors, of several blocks. @throws Error as make_vector_field().
[[nodiscard]] std::shared_ptr<const VectorField> make_vector_field(std::shared_ptr<const FieldGrid> grid,
                                                                   const std::vector<DataSet>& blocks,
                                                                   const VectorChoice& choice,
                                                                   const std::string& file, int threads = 0);

/// The same of tensors. @throws Error as make_tensor_field().
[[nodiscard]] std::shared_ptr<const TensorField> make_tensor_field(
    std::shared_ptr<const FieldGrid> grid, const DataSet& image, const TensorChoice& choice,
    const std::string& file, int threads = 0, const std::vector<std::string>& notes = {});

}  // namespace palpate
