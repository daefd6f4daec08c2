/// Built-in volumes: made on the fly, and handed over as a loader would, in the types that files have.
#pragma once

#include <memory>
#include <string_view>
#include <vector>

#include "common/field/analytic/analytic_scalar.h"
#include "common/field/analytic/examples.h"
#include "common/field/data_set.h"

namespace palpate {

/// Name of the array of built-in volumes.
inline constexpr const char* kVolumeArray = "scalars";

/// All of them; the first is the one shown by default.
[[nodiscard]] std::vector<ExampleInfo> volume_examples();

/// One uniform block with one point array.
/// @throws Error (usage) that lists the known ones.
[[nodiscard]] DataSet volume_example(std::string_view name);

/// |x|^2 over [-1.5, 1.5]^3: the isosurface of value r^2 is the sphere of radius r.
[[nodiscard]] std::shared_ptr<const AnalyticScalar> sphere_scalar();

/// The test signal of Marschner and Lobb 1994, f_M = 6 and alpha = 1/4, over [-1, 1]^3:
///   s = (1 - sin(pi z / 2) + alpha (1 + rho(r))) / (2 (1 + alpha)),  rho(r) = cos(2 pi f_M cos(pi r / 2)),
/// r^2 = x^2 + y^2.
[[nodiscard]] std::shared_ptr<const AnalyticScalar> marschner_lobb_scalar();

}  // namespace palpate
