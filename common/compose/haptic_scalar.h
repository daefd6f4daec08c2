/// The scalar that is felt of a flow, as `--scalar` names it.
#pragma once

#include <memory>
#include <string>

#include "common/base/progress.h"
#include "common/field/scalar_field.h"
#include "common/field/vector_field.h"
#include "common/scene/input.h"

namespace palpate {

/// The array `name` of the input on the grid of `field`, of several components its magnitude; the speed of
/// `field` where `name` is empty or "speed".
/// @throws Error (usage) that lists what is known; Error, Cancelled where the array has to be read.
[[nodiscard]] std::shared_ptr<const ScalarField> haptic_scalar(
    const std::string& name, Input& input, const std::shared_ptr<const VectorField>& field, int threads,
    Progress* progress);

/// What tells a felt scalar from others of the same field in the names that recordings carry; empty for the
/// default one.
[[nodiscard]] std::string scalar_key(const std::string& name);

}  // namespace palpate
