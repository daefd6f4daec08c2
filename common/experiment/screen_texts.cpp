#include "common/experiment/screen_texts.h"

#include <fstream>
#include <sstream>

#include "common/base/error.h"
#include "common/base/text.h"

namespace palpate {

std::string welcome_text(std::size_t done, std::size_t left, bool mouse) {
  std::string text = "Welcome.\n\nYou will see pictures of data and work in them with a crosshair, ";
  text += mouse ? "which the mouse leads." : "which the device in your hand leads.";
  text +=
      "\n\nEach trial begins at a blue dot. Bring the crosshair there; where your device can, it pulls you. "
      "The space bar begins the trial, and ends it when you are done.\n\n"
      "There are breaks between trials, as long as you like. You can stop at any time with Esc: what you have done "
      "is stored, and you can go on later.\n\n";
  text += done > 0 ? "You have done " + counted(done, "trial") + "; " + std::to_string(left) + " are left."
                   : counted(left, "trial") + ".";
  return text + "\n\nPress the space bar.";
}

std::string task_text(const StudyTaskInfo& info, bool practice, bool wheel) {
  return info.title + "\n\n" + info.instruction + "\n\nPlease take no longer than " +
         short_number(info.limit) + " seconds." +
         (wheel ? "\n\nThe wheel of the mouse leads the crosshair away from you and towards you." : "") +
         (practice ? "\n\nThe first trials are for practice." : "") + "\n\nPress the space bar.";
}

std::string pause_text(std::size_t done, std::size_t left, bool practice, const std::string& last) {
  return (last.empty() ? std::string() : last + "\n\n") + counted(done, "trial") + " done, " +
         std::to_string(left) + " left." + (practice ? " The next one is for practice." : "") +
         "\n\nYou may take a break.\n\nPress the space bar for the next trial.";
}

std::string read_whole(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  if (!in) throw work_error(file.string() + ": cannot be read (" + errno_text() + ")");
  return text.str();
}

}  // namespace palpate
