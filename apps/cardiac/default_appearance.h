/// What colours a heart, and at which time step it is shown, where nobody says.
#pragma once

#include <string>

#include "common/base/progress.h"
#include "common/scene/document/document.h"
#include "common/scene/input.h"

namespace palpate {

/// `--angle`, or the helix angle.
[[nodiscard]] std::string angle_of(const HeartOptions& options);

/// Fills in an angle that is not given: the helix angle, or where the input has time steps the first scalar
/// of its points that changes between five of them, spread over the series. Where no time is given either,
/// the input goes to the first of these steps at which that scalar spreads nearly as far as at any: at the
/// very beginning of a wave all is at rest.
/// @return a sentence that says what was chosen; empty where nothing was.
/// @throws Error, Cancelled.
std::string choose_default_appearance(Input& input, Document& options, Progress* progress);

}  // namespace palpate
