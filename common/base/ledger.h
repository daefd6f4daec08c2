/// What this process did, as `--explain` prints it.
///
/// Each part of the work that takes time or memory, starts a program or brings a library along enters itself, where it does
/// so. Nothing is foretold: what nobody entered was not done. For work of milliseconds; nothing of the servo's belongs here.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/clock.h"

namespace palpate {

struct LedgerEntry {
  std::string what;           ///< "helper vtk", "array velocity", "tetrahedra"
  std::string why;            ///< what it was for; of what was left out, why
  std::size_t times = 0;      ///< how often; 0: left out
  double milliseconds = 0.0;  ///< by the clock, all times together; a part may lie within another
  std::uint64_t bytes =
      0;  ///< of memory, or of a file: the most of all times; 0 where there are none to speak of
};

/// Of the process; from any thread.
class Ledger {
 public:
  /// `what` was done.
  static void enter(std::string_view what, std::string_view why, double milliseconds,
                    std::uint64_t bytes = 0);
  /// `what` could be done: it counts as left out until somebody enters it. @param why_not the reason then.
  static void offer(std::string_view what, std::string_view why_not, std::uint64_t bytes = 0);
  /// What another process did for this one.
  static void add(const std::vector<LedgerEntry>& entries);
  /// In the order of their first mention.
  [[nodiscard]] static std::vector<LedgerEntry> entries();
  static void clear();
};

/// Enters a part of the work at the end of its scope, however it ends.
class Work {
 public:
  Work(std::string what, std::string why) : what_(std::move(what)), why_(std::move(why)) {}
  ~Work() { Ledger::enter(what_, why_, 1e3 * watch_.seconds(), bytes_); }
  Work(const Work&) = delete;
  Work& operator=(const Work&) = delete;

  void takes(std::uint64_t bytes) noexcept { bytes_ = bytes; }

 private:
  std::string what_, why_;
  std::uint64_t bytes_ = 0;
  Stopwatch watch_;
};

/// Lines for people: what was done, then what was left out.
[[nodiscard]] std::string ledger_text(const std::vector<LedgerEntry>& entries);

}  // namespace palpate
