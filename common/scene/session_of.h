/// Saving what a window shows as a session: the part that all explorers share.
#pragma once

#include <string>

#include "common/scene/input.h"
#include "common/scene/session.h"

namespace palpate {

/// Saved angles hold for any window; the zoom is stated for a picture of this shape (width / height).
inline constexpr double kSessionAspect = 1.5;

/// A session with the inputs of `spec` and no options yet. @throws Error (bad input) where one cannot be
/// read.
[[nodiscard]] Session begin_session(const InputSpec& spec, const std::string& program);

/// Writes it beside the first input, or where that cannot be written, or there is none, into the current
/// folder.
/// @return what was written. @throws Error (work failed).
std::string store_session(const Session& session, const InputSpec& spec);

}  // namespace palpate
