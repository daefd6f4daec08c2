/// The image of tensors that a file stands for: its tensors brought into the data's axes.
#pragma once

#include <string>
#include <vector>

#include "common/base/progress.h"
#include "common/field/data_set.h"
#include "common/field/tensor/tensor_field.h"
#include "common/field/tensor/tensor_source.h"

namespace palpate {

/// An image with one array of tensors in the axes of its coordinates.
struct TensorImage {
  DataSet image;
  TensorChoice choice;             ///< which array, and in which order its numbers stand
  std::vector<std::string> notes;  ///< what was assumed or found, for the user
};

/// @param blocks of the file, with the arrays of `source`.
/// @throws Error (bad input) with `file` where they make no tensors; Cancelled.
[[nodiscard]] TensorImage make_tensor_image(std::vector<DataSet> blocks, const TensorSource& source,
                                            const DiffusionInfo& diffusion, const std::string& file,
                                            int threads, Progress* progress = nullptr);

}  // namespace palpate
