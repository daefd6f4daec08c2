/// A helper program and the explorer's end of its socket pair.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

#include <sys/types.h>

#include "common/base/progress.h"
#include "common/load/helper/channel.h"
#include "common/load/helper/memory_file.h"
#include "common/load/load.h"

namespace palpate {

/// How the last exchange with a helper went wrong.
struct HelperFailure {
  enum class Kind { kTimeOut, kEnded, kMalformed };
  Kind kind = Kind::kEnded;
  std::string what;  ///< "ended by signal 11 (Segmentation fault)"
};

/// No bounds: for a helper that works on what its explorer vouches for.
inline constexpr LoadLimits kUnlimited{.memory_bytes = std::numeric_limits<std::uint64_t>::max(),
                                       .seconds = std::numeric_limits<double>::infinity()};

/// A running helper program: no input, no terminal, an address space and a largest file of
/// `limits.memory_bytes`, no core dumps; Ctrl-C at the terminal does not reach it (its explorer decides).
class HelperProcess {
 public:
  /// @throws Error (work failed) where the system cannot start another process.
  HelperProcess(const std::filesystem::path& program, const LoadLimits& limits);
  ~HelperProcess();  ///< ends the helper at once
  HelperProcess(const HelperProcess&) = delete;
  HelperProcess& operator=(const HelperProcess&) = delete;

  struct Reply {
    std::string_view json;  ///< lies in `memory`
    std::shared_ptr<const MappedMemory> memory;
  };

  /// Sends a request and waits for its answer at most `limits.seconds`; on a busy machine, where it had a processor
  /// for less than half of them, up to three times as long. Empty: see failure(); the helper
  /// was ended then.
  /// @throws Cancelled, within a tenth of a second of `progress` being cancelled; the helper is ended.
  std::optional<Reply> ask(std::string_view json, Progress* progress);
  /// The same with arrays that `json` speaks of. @param doing what the progress says until the helper says
  /// something else. @param news called with what the helper says to the user before it answers; may be empty.
  std::optional<Reply> ask(MemoryFile& arrays, std::string_view json, Progress* progress,
                           const std::string& doing,
                           const std::function<void(std::string_view json)>& news = {});

  [[nodiscard]] const HelperFailure& failure() const noexcept { return failure_; }
  [[nodiscard]] pid_t pid() const noexcept { return pid_; }

 private:
  std::optional<Reply> fail(HelperFailure::Kind kind, std::string what);
  std::string how_it_ended();
  [[nodiscard]] double worked() const noexcept;
  void end() noexcept;

  LoadLimits limits_;
  pid_t pid_ = -1;
  UniqueFd socket_;
  UniqueFd errors_;  ///< what the helper and its libraries print
  HelperFailure failure_;
};

}  // namespace palpate
