/// The image of tensors that a file stands for: read, put together or fitted, in the axes of its coordinates.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/base/progress.h"
#include "common/field/data_set.h"
#include "common/field/tensor/tensor_field.h"
#include "common/field/tensor/tensor_fit.h"
#include "common/field/tensor/tensor_source.h"
#include "common/scene/tensor/tensor_spec.h"

namespace palpate {

/// An image with one array of tensors in the axes of its coordinates; of a fit with FitOptions::details also
/// kConeArray and kBaselineArray (tensor_measure.h).
struct TensorImage {
  DataSet image;
  TensorChoice choice;             ///< which array, and in which order its numbers stand
  std::vector<std::string> notes;  ///< what was assumed or found, for the user
  std::optional<TensorFit> fit;    ///< where it was fitted: its counts (the tensors are in `image`)
  GradientTable gradients;         ///< that it was fitted with; empty where it was not
  OrientationVerdict orientation;  ///< of images from files
};

/// What a file holds, opened.
struct TensorInput {
  const TensorSource& source;
  const DiffusionInfo& diffusion;
  const std::string& file;  ///< for messages
  bool measured = true;     ///< false for what was made on the fly: its axes are beyond doubt
};

/// @param blocks of the file, with the arrays of the source.
/// @throws Error (bad input) where they make no tensors or the gradients do not determine one; Cancelled.
[[nodiscard]] TensorImage make_tensor_image(std::vector<DataSet> blocks, const TensorInput& input,
                                            const TensorReading& reading, int threads,
                                            Progress* progress = nullptr);

}  // namespace palpate
