/// Locks of an experiment's files against a second program.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "common/base/files/unique_fd.h"

namespace palpate {

/// Holds a file against other programs, until it is destroyed or the program ends, however it ends.
class StudyLock {
 public:
  enum class Kind : std::uint8_t { kAlone, kShared };

  /// Takes it. @param by who does, as another program is told. @throws Error (usage) that says who holds it; (work
  /// failed) where the file cannot be made.
  StudyLock(const std::filesystem::path& file, Kind kind, const std::string& by);
  /// Waits for it. @throws Error (work failed).
  explicit StudyLock(const std::filesystem::path& file);

 private:
  UniqueFd fd_;
};

}  // namespace palpate
