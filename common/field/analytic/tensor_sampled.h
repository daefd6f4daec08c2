/// Fields of tensors given by a formula as the images that a loader would deliver.
#pragma once

#include "common/field/analytic/analytic_tensor.h"
#include "common/field/data_set.h"

namespace palpate {

/// The array of such images: six floats a point, as TensorOrder::kRows.
inline constexpr const char* kTensorArray = "tensor";

/// One uniform block over the formula's bounds.
/// @param points at least two an axis.
/// @param noise standard deviation of what is added to the tensors [mm^2/s]: on the diagonal, and 1/sqrt(2)
/// of it off the diagonal, so that it has no preferred direction. The same for the same points.
[[nodiscard]] DataSet sample_tensors(const AnalyticTensor& formula, const Index3& points, double noise);

}  // namespace palpate
