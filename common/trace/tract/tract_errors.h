/// What tracts state of their own errors, taken together.
#pragma once

#include <optional>

#include "common/trace/line_errors.h"
#include "common/trace/tract/trace_tracts.h"

namespace palpate {

/// The error of a line is the largest that its points state. A line keeps the tolerance where at each of its ends no more than
/// that part of the way from its seed is stated. @param tolerance error per length. @param diagonal of the image, data units:
/// lines whose error is a tenth of it are not held (line_errors.h), and are named by the numbers of their seeds.
[[nodiscard]] LineErrors tract_errors(const TractResult& result, double diagonal,
                                      std::optional<double> tolerance = std::nullopt);

}  // namespace palpate
