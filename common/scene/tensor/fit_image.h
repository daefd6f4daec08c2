/// The tensor fit of an image of diffusion-weighted signals, inside its mask.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "common/base/progress.h"
#include "common/field/data_set.h"
#include "common/field/tensor/gradient_choice.h"
#include "common/field/tensor/tensor_fit.h"
#include "common/scene/tensor/tensor_spec.h"

namespace palpate {

/// A fit, and the volumes that it took.
struct FittedImage {
  TensorFit fit;
  ChosenGradients gradients;
  bool doubtful = false;  ///< the table hardly determines tensors, which was said
};

/// Fits tensors to the volumes that `reading` leaves of `table` and that serve, where the mask of `reading` says: the foreground of the mean of the unweighted volumes (of
/// all, where there is none), an image file, or everywhere. Notes say what was fitted, how well the table determines
/// tensors, and how often a signal was not above zero or an eigenvalue below it.
/// @throws Error (bad input) where the gradients do not determine a tensor, or the mask has no voxel in the image;
/// Cancelled.
[[nodiscard]] FittedImage fit_image(const DataArray& signals, const UniformTopology& topology,
                                    const GradientTable& table, const TensorReading& reading,
                                    const std::string& file, int threads, std::vector<std::string>& notes,
                                    Progress* progress);

/// The share of tensors with an eigenvalue below zero; a warning where it is above 10 %, nothing where it is
/// zero.
void say_negative(std::size_t negative, std::size_t tensors, std::vector<std::string>& notes);

}  // namespace palpate
