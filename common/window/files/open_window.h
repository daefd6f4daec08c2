/// The window that a verb opens, as the user left it the last time.
#pragma once

#include <vector>

#include "common/hand/window_request.h"
#include "common/window/panels/panel.h"

namespace palpate {

/// The window of window.h. Call `open` on the main thread. @param panels the program's parts of the panel.
[[nodiscard]] WindowMaker user_window(std::vector<PanelPart> panels);

}  // namespace palpate
