#include <utility>

#include "common/base/error.h"
#include "common/window/user_settings.h"
#include "common/window/window.h"

namespace palpate {

WindowResult run_user_window(WindowModel& model, WindowOptions options, const Document& given,
                             const std::function<void(const std::string&)>& note) {
  const auto files = user_files(options.program);
  if (!files) return run_window(model, options);
  std::vector<std::string> reported;  // by prefer()
  const UserSettings before = load_user_settings(*files, reported);
  options.width = before.width;
  options.height = before.height;
  options.recent = before.recent;
  options.thumbnails = files->thumbnails;
  options.touch.fault_folder = files->recent.parent_path();
  WindowResult result = run_window(model, options);
  UserSettings after{.width = result.width,
                     .height = result.height,
                     .appearance = before.appearance,
                     .recent = result.recent};
  if (result.shown) note_preferences(given, result.document, after.appearance);
  try {
    save_user_settings(*files, after, before);
  } catch (const Error& error) {
    note(error.what());
  }
  return result;
}

void prefer(const std::string& program, Document& document,
            const std::function<void(const std::string&)>& note) {
  const auto files = user_files(program);
  if (!files) return;
  std::vector<std::string> notes;
  take_preferences(load_user_settings(*files, notes).appearance, document);
  for (const std::string& line : notes) note(line);
}

}  // namespace palpate
