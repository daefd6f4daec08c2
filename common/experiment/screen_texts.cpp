#include "common/experiment/screen_texts.h"

#include <fstream>
#include <sstream>
#include <utility>

#include "common/base/error.h"
#include "common/base/text.h"

namespace palpate {

std::string welcome_text(std::size_t done, std::size_t left, bool mouse) {
  std::string text = "Welcome.\n\nYou will see pictures of data and work in them with a crosshair, ";
  text += mouse ? "which the mouse leads." : "which the device in your hand leads.";
  text +=
      "\n\nEach trial begins at a blue dot. Bring the crosshair there; where your device can, it pulls you. "
      "The space bar begins the trial, and ends it when you are done.\n\n"
      "The key F12 takes all force off at any time.\n\n"
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

std::string refusal_text(ForceCut cut, bool latched) {
  std::string why;
  switch (cut) {
    case ForceCut::kNone:
    case ForceCut::kStart:
    case ForceCut::kJump:
      if (!latched) return {};
      break;
    case ForceCut::kNoHand:
      why = "Nothing is heard of the device.";
      break;
    case ForceCut::kSwitchedOff:
      why = "The force is switched off.";
      break;
    case ForceCut::kOutOfReach:
      return "There is no force out here. Bring the hand back towards the middle.";
    case ForceCut::kReleased:
      return "Hold the button that lets the device show force.";
    case ForceCut::kTooFast:
      why = "The hand was too fast: the force is off.";
      break;
    default:
      why = "The device has a fault (" + std::string(name_of(cut)) +
            "): there is no force. Please call for help.";
      break;
  }
  if (why.empty()) why = "The force is off.";
  return why + (latched ? " Hold the hand still, then press the space bar: it comes back." : "");
}

std::string flaw_text(bool again) {
  return again
             ? "The force was off during the trial. It does not count, and comes again at the end of this part."
             : "The force was off during the trial. It does not count.";
}

std::string flaws_text(const TrialFlaws& flaws) {
  std::string text;
  const std::pair<std::uint64_t, const char*> counts[]{
      {flaws.cut, "without force"},
      {flaws.off, "with the force switched off"},
      {flaws.faults, "with a fault of the device or the servo"},
      {flaws.lost, "lost"}};
  for (const auto& [count, what] : counts) {
    if (count > 0) text += (text.empty() ? "" : ", ") + counted(count, "step") + " " + what;
  }
  return text;
}

std::string read_whole(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  if (!in) throw work_error(file.string() + ": cannot be read (" + errno_text() + ")");
  return text.str();
}

}  // namespace palpate
