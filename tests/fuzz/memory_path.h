/// A fuzzer's input as a file that only exists in memory, for readers that want a path.
#pragma once

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <string>

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include "common/base/files/unique_fd.h"

namespace palpate::test {

class MemoryPath {
 public:
  MemoryPath(const std::uint8_t* data, std::size_t size)
      : data_(data), size_(size), fd_(::memfd_create("input", MFD_CLOEXEC)) {
    if (::write(fd_.get(), data, size) != static_cast<ssize_t>(size)) std::abort();
  }
  [[nodiscard]] std::string path() const { return "/proc/self/fd/" + std::to_string(fd_.get()); }

  /// The same as a file of that name, alone in a folder, for readers that look at names and at neighbours, or follow links as
  /// HDF5 does. One of a process at a time.
  [[nodiscard]] std::filesystem::path path(const std::string& name) const {
    static const std::filesystem::path folder = [] {
      const std::filesystem::path memory = "/dev/shm";
      const auto in = std::filesystem::is_directory(memory) ? memory : std::filesystem::temp_directory_path();
      std::string made = (in / "palpate-fuzz-XXXXXX").string();
      if (::mkdtemp(made.data()) == nullptr) std::abort();
      return made;
    }();
    for (const auto& old : std::filesystem::directory_iterator(folder)) std::filesystem::remove(old);
    return beside(folder / name);
  }
  /// The same as `file`, beside others.
  [[nodiscard]] std::filesystem::path beside(const std::filesystem::path& file) const {
    const UniqueFd fd(::open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600));
    if (::write(fd.get(), data_, size_) != static_cast<ssize_t>(size_)) std::abort();
    return file;
  }

 private:
  const std::uint8_t* data_;
  std::size_t size_;
  UniqueFd fd_;
};

}  // namespace palpate::test
