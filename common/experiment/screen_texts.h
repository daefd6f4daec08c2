/// What participants read between trials.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "common/servo/safety_stage.h"
#include "common/study/task.h"
#include "common/study/trial_run.h"

namespace palpate {

/// @param done, left trials. @param mouse whether the cursor is led by it.
[[nodiscard]] std::string welcome_text(std::size_t done, std::size_t left, bool mouse);
/// @param wheel whether the mouse's wheel leads through the depth.
[[nodiscard]] std::string task_text(const StudyTaskInfo& info, bool practice, bool wheel);
/// @param last what is said of the last trial; may be empty.
[[nodiscard]] std::string pause_text(std::size_t done, std::size_t left, bool practice,
                                     const std::string& last);
/// Why there is no force before a trial, and what the participant is to do; empty where nothing keeps it away.
/// @param latched it comes back by the space bar alone.
[[nodiscard]] std::string refusal_text(ForceCut cut, bool latched);
inline constexpr const char* kNoForceInTrial =
    "The force is off. Press the space bar: this trial does not count.";
/// What is said of a trial in which there was no force. @param again it is repeated.
[[nodiscard]] std::string flaw_text(bool again);
/// "12 steps without force, 3 with the force switched off": for who leads the experiment.
[[nodiscard]] std::string flaws_text(const TrialFlaws& flaws);
inline constexpr const char* kThanksText =
    "Thank you for taking part.\n\nEverything is stored. You may close the window now (Esc).";

/// All of a file. @throws Error (work failed).
[[nodiscard]] std::string read_whole(const std::filesystem::path& file);

}  // namespace palpate
