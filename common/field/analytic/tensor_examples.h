/// Built-in diffusion-tensor images, with the formulas that they are made of.
///
/// Bundles are of white matter's diffusivities, (1.7, 0.3, 0.3) 10^-3 mm^2/s (Pierpaoli and Basser 1996), in
/// surroundings that are isotropic and of the same trace; the border between the two is smooth.
#pragma once

#include <memory>
#include <string_view>
#include <vector>

#include "common/field/analytic/analytic_tensor.h"
#include "common/field/analytic/examples.h"
#include "common/field/data_set.h"

namespace palpate {

/// All of them; the first is the one shown by default.
[[nodiscard]] std::vector<ExampleInfo> tensor_examples();

/// The formula of an example, without noise.
/// @throws Error (usage) that lists the known ones.
[[nodiscard]] std::shared_ptr<const AnalyticTensor> tensor_formula(std::string_view name);

/// Its image: voxels of 2 mm, sample_tensors() with the noise of the formula.
/// @throws as tensor_formula().
[[nodiscard]] DataSet tensor_example(std::string_view name);

}  // namespace palpate
