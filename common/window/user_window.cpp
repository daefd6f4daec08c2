#include <utility>

#include "common/base/error.h"
#include "common/window/user_settings.h"
#include "common/window/window.h"

namespace palpate {

WindowResult run_user_window(WindowModel& model, WindowOptions options,
                             const std::function<void(const std::string&)>& note) {
  const auto files = user_files(options.program);
  if (!files) return run_window(model, options);
  std::vector<std::string> notes;
  const UserSettings before = load_user_settings(*files, notes);
  for (const std::string& line : notes) note(line);
  options.width = before.width;
  options.height = before.height;
  options.recent = before.recent;
  apply_appearance(before.look, options.view);
  options.touch.fault_folder = files->recent.parent_path();
  WindowResult result = run_window(model, options);
  const UserSettings after{.width = result.width,
                           .height = result.height,
                           .look = appearance_of(result.view),
                           .recent = result.recent};
  try {
    save_user_settings(*files, after, before);
  } catch (const Error& error) {
    note(error.what());
  }
  return result;
}

}  // namespace palpate
