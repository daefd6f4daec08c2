/// Input events as the text of a recording, one line each: "move 512.5 300", "press 0", "keydown 71 0".
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "common/window/input_event.h"

namespace palpate {

/// Empty for dropped files, which a recording does not repeat.
[[nodiscard]] std::string event_text(const InputEvent& event);
/// Absent where `text` is no event.
[[nodiscard]] std::optional<InputEvent> event_from_text(std::string_view text);

}  // namespace palpate
