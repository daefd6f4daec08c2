/// The window that a verb opens, as the user left it the last time.
#pragma once

#include "common/hand/window_request.h"

namespace palpate {

/// The window of window.h. Call `open` on the main thread.
[[nodiscard]] WindowMaker user_window();

}  // namespace palpate
