/// A file that appears under its name only when it is complete.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/clock.h"
#include "common/base/files/unique_fd.h"

namespace palpate {

/// Writes under a temporary name in the same folder (".name.pid.part"); finish() renames. Without finish()
/// nothing is left. A program that was killed can leave its temporary file: the next one that writes the same
/// name removes it.
class OutputFile {
 public:
  /// @throws Error (usage) where `path` exists and `overwrite` is not set; (work failed) where its folder
  /// cannot be written or `path` is a folder or device.
  OutputFile(const std::filesystem::path& path, bool overwrite);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  /// @throws Error (work failed) where the disk refuses.
  void write(std::span<const std::byte> bytes);
  void write(std::string_view text) { write(std::as_bytes(std::span(text))); }
  /// The bytes of a number as they lie in memory.
  template <typename T>
  void write_number(T value) {
    write(std::as_bytes(std::span(&value, 1)));
  }
  void finish();

 private:
  void flush();
  [[noreturn]] void refuse(const char* what);

  std::filesystem::path path_;
  std::filesystem::path temporary_;
  bool overwrite_;
  UniqueFd fd_;
  std::vector<std::byte> buffer_;
  Stopwatch watch_;
};

/// Removes the temporary files of all OutputFiles at work, for a program that ends without unwinding. What
/// they write from then on is lost. Safe from any thread, not from a signal handler.
void remove_unfinished_outputs() noexcept;

/// What OutputFile's constructor checks, without making a file.
/// @throws Error as it does.
void check_output(const std::filesystem::path& path, bool overwrite);

/// Whether the folder of `path` can be written and is meant to be: root may write to what nobody should, so
/// that it takes more than access().
[[nodiscard]] bool may_cache_beside(const std::filesystem::path& path);

}  // namespace palpate
