/// Ctrl-C: cancels the job in hand, and ends the program where the job does not notice within a second.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "common/base/progress.h"

namespace palpate {

/// While it lives, SIGINT, SIGTERM and SIGHUP take the force away at once and cancel `progress`. 0.8 s later a program that is still at work does
/// its last acts (last_acts.h), removes what it was writing (output_file.h) and the unfinished outputs that
/// it announced, says what was saved and exits with 130; a second signal does so at once. One at a time.
class InterruptGuard {
 public:
  InterruptGuard(Progress& progress, std::string program);
  ~InterruptGuard();
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;

  [[nodiscard]] static bool interrupted() noexcept;
  /// Names an output that is complete and stays whatever happens next.
  void keep(const std::filesystem::path& output);
  /// Announces a file or folder that is removed if the program has to be ended.
  void unfinished(const std::filesystem::path& temporary);
  /// "nothing was saved", "saved: lines.vtp"
  [[nodiscard]] std::string saved() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace palpate
