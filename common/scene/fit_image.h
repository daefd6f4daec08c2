/// The tensor fit of an image of diffusion-weighted signals, inside its mask.
#pragma once

#include <string>
#include <vector>

#include "common/base/progress.h"
#include "common/field/data_set.h"
#include "common/field/tensor/tensor_fit.h"
#include "common/scene/tensor_spec.h"

namespace palpate {

/// Fits tensors where the mask of `reading` says: the foreground of the mean of the unweighted volumes (of
/// all, where there is none), an image file, or everywhere. Notes say what was fitted, and how often a signal
/// was not above zero or an eigenvalue below it.
/// @throws Error (bad input) where the gradients do not determine a tensor, or the mask has no voxel in the image;
/// Cancelled.
[[nodiscard]] TensorFit fit_image(const DataArray& signals, const UniformTopology& topology,
                                  const GradientTable& table, const TensorReading& reading,
                                  const std::string& file, int threads, std::vector<std::string>& notes,
                                  Progress* progress);

}  // namespace palpate
