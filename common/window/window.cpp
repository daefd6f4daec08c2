#include "common/window/window.h"

#include "common/window/explorer_window.h"
#include "common/window/glfw_window.h"

namespace palpate {

bool window_available() { return start_glfw(); }

WindowResult run_window(WindowModel& model, const WindowOptions& options) {
  return ExplorerWindow(model, options).run();
}

}  // namespace palpate
