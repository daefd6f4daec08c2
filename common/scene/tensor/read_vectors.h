/// The arrays of a vector field, with values of cells as the document wants them.
#pragma once

#include <string>
#include <vector>

#include "common/scene/input.h"

namespace palpate {

/// Reads the arrays of `choice` at the input's time step. Where values of cells are to be constant over their cells
/// (InputOptions::cell_values), blocks of which they are, and `choice` is that of their points then.
/// @param notes get what that loses. @throws Error, Cancelled.
[[nodiscard]] std::vector<DataSet> read_vectors(Input& input, VectorChoice& choice,
                                                Progress* progress = nullptr,
                                                std::vector<std::string>* notes = nullptr);

}  // namespace palpate
