/// Opening what a document names, with what its user should know of it.
#pragma once

#include <functional>
#include <string>

#include "common/base/progress.h"
#include "common/scene/document/document.h"
#include "common/scene/input.h"

namespace palpate {

/// @param note told in a sentence what is no longer as the session was saved with, and what the loader has to
/// say. @throws Error as Input::open(), and for a session that cannot be read; Cancelled.
[[nodiscard]] Input open_input(const Document& document, Progress& progress,
                               const std::function<void(const std::string&)>& note);

}  // namespace palpate
