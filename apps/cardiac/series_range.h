/// One range of colours for all time steps of a scalar: a picture that plays says by its colours what
/// changes, not by another range each step.
#pragma once

#include <optional>

#include "common/base/progress.h"
#include "common/field/field_grid.h"
#include "common/field/scalar_field.h"
#include "common/render/line_style.h"
#include "common/scene/input.h"

namespace palpate {

/// From 0.5 % to 99.5 % of the values at the points of the heart, at up to five steps that are spread over
/// the series by number, the first and the last among them, and at all that have been shown since: there the
/// range may still grow, and never shrinks. None where there is one step.
/// @param now at the input's step.  @param before of the same scalar at steps before; none: the five are
/// read.
/// @throws Error, Cancelled. The input stays at its step.
[[nodiscard]] std::optional<ValueRange> series_range(Input& input, const ScalarChoice& choice,
                                                     const ScalarField& now,
                                                     const std::shared_ptr<const FieldGrid>& grid,
                                                     const std::optional<ValueRange>& before, int threads);

/// Up to five steps of a series, spread over it in the order of time, the first and the last among them.
[[nodiscard]] std::vector<std::size_t> spread_steps(const Input& input);

/// As stored, at the points of its mesh.
[[nodiscard]] std::vector<double> point_values(const ScalarField& field);

}  // namespace palpate
