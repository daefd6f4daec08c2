/// What participants read between trials.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "common/study/task.h"

namespace palpate {

/// @param done, left trials. @param mouse whether the cursor is led by it.
[[nodiscard]] std::string welcome_text(std::size_t done, std::size_t left, bool mouse);
/// @param wheel whether the mouse's wheel leads through the depth.
[[nodiscard]] std::string task_text(const StudyTaskInfo& info, bool practice, bool wheel);
/// @param last what is said of the last trial; may be empty.
[[nodiscard]] std::string pause_text(std::size_t done, std::size_t left, bool practice,
                                     const std::string& last);
inline constexpr const char* kThanksText =
    "Thank you for taking part.\n\nEverything is stored. You may close the window now (Esc).";

/// All of a file. @throws Error (work failed).
[[nodiscard]] std::string read_whole(const std::filesystem::path& file);

}  // namespace palpate
