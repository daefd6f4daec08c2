/// Errors that end a command: what the world did to us, with the exit code of the command line.
///
/// A broken promise of a caller is a PALPATE_CHECK (check.h); an ordinary numerical event is a value in
/// a result; neither is an Error.
#pragma once

#include <cerrno>
#include <stdexcept>
#include <string>
#include <system_error>

namespace palpate {

/// Exit codes of every program (design: command line).
enum class ExitCode : int {
  kDone = 0,
  kWorkFailed = 1,    ///< the work failed; an output that cannot be written too
  kUsage = 2,         ///< unknown option, field or mode
  kBadInput = 3,      ///< a missing or malformed input file
  kInterrupted = 130  ///< Ctrl-C, or a cancelled job
};

/// An error for the user: one line, without a trailing full stop or newline.
class Error : public std::runtime_error {
 public:
  Error(ExitCode code, const std::string& line) : std::runtime_error(line), code_(code) {}
  [[nodiscard]] ExitCode code() const noexcept { return code_; }

 private:
  ExitCode code_;
};

/// A file that is missing or malformed. The line reads `file: place: found; expected …; remedy`; empty
/// parts are left out. What files and users wrote into it is shown as printable() does.
struct InputProblem {
  std::string file;      ///< the path as the user gave it
  std::string place;     ///< line number, byte offset, array or block name
  std::string found;     ///< what is wrong
  std::string expected;  ///< what would have been right
  std::string remedy;    ///< what the user can do
};

[[nodiscard]] Error input_error(const InputProblem& problem);
[[nodiscard]] Error usage_error(const std::string& line);
[[nodiscard]] Error work_error(const std::string& line);

/// Thrown where a cancelled job notices it.
class Cancelled : public Error {
 public:
  explicit Cancelled(const std::string& kept = "cancelled") : Error(ExitCode::kInterrupted, kept) {}
};

/// What errno says, in words: std::strerror() may not be called from several threads.
[[nodiscard]] inline std::string errno_text() { return std::generic_category().message(errno); }

}  // namespace palpate
