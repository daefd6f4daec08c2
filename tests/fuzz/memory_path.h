/// A fuzzer's input as a file that only exists in memory, for readers that want a path.
#pragma once

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <string>

#include <sys/mman.h>
#include <unistd.h>

#include "common/base/files/unique_fd.h"

namespace palpate::test {

class MemoryPath {
 public:
  MemoryPath(const std::uint8_t* data, std::size_t size) : fd_(::memfd_create("input", MFD_CLOEXEC)) {
    if (::write(fd_.get(), data, size) != static_cast<ssize_t>(size)) std::abort();
  }
  [[nodiscard]] std::string path() const { return "/proc/self/fd/" + std::to_string(fd_.get()); }

  /// The same under a name, alone in a folder, for readers that look at names and at neighbours. One of a process at a time.
  [[nodiscard]] std::string path(const std::string& name) const {
    static const std::filesystem::path folder = [] {
      std::string made = (std::filesystem::temp_directory_path() / "palpate-fuzz-XXXXXX").string();
      if (::mkdtemp(made.data()) == nullptr) std::abort();
      return made;
    }();
    for (const auto& old : std::filesystem::directory_iterator(folder)) std::filesystem::remove(old);
    std::filesystem::create_symlink(path(), folder / name);
    return folder / name;
  }

 private:
  UniqueFd fd_;
};

}  // namespace palpate::test
