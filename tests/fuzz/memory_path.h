/// A fuzzer's input as a file that only exists in memory, for readers that want a path.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include "common/base/files/unique_fd.h"

namespace palpate::test {

class MemoryPath {
 public:
  MemoryPath(const std::uint8_t* data, std::size_t size) : data_(data), size_(size) {}

  [[nodiscard]] std::string path() const {
    fd_.reset(::memfd_create("input", MFD_CLOEXEC));
    write_all(fd_.get());
    return "/proc/self/fd/" + std::to_string(fd_.get());
  }

  /// The same as a file of that name, alone in a folder, for readers that look at names and at neighbours, or follow links as
  /// HDF5 does. One of a process at a time.
  [[nodiscard]] std::filesystem::path path(const std::string& name) const {
    Folder& folder = Folder::of_process();
    if (folder.holds != std::vector{name}) {
      for (const auto& old : std::filesystem::directory_iterator(folder.path)) std::filesystem::remove(old);
      folder.holds.clear();
    }
    return beside(folder.path / name);
  }
  /// The same as `file`, beside others.
  [[nodiscard]] std::filesystem::path beside(const std::filesystem::path& file) const {
    Folder& folder = Folder::of_process();
    const std::string name = file.filename().string();
    if (std::ranges::find(folder.holds, name) == folder.holds.end()) folder.holds.push_back(name);
    const UniqueFd fd(::open(file.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0600));
    write_all(fd.get());
    return file;
  }

 private:
  /// Where files with names lie. Most inputs have the name of the one before, whose file then takes them.
  struct Folder {
    std::filesystem::path path;
    std::vector<std::string> holds;

    static Folder& of_process() {
      static Folder folder{[] {
                             const std::filesystem::path memory = "/dev/shm";
                             const auto in = std::filesystem::is_directory(memory)
                                                 ? memory
                                                 : std::filesystem::temp_directory_path();
                             std::string made = (in / "palpate-fuzz-XXXXXX").string();
                             if (::mkdtemp(made.data()) == nullptr) std::abort();
                             return made;
                           }(),
                           {}};
      return folder;
    }
  };
  void write_all(int fd) const {
    if (::write(fd, data_, size_) != static_cast<ssize_t>(size_)) std::abort();
    if (::ftruncate(fd, static_cast<off_t>(size_)) != 0) std::abort();
  }

  const std::uint8_t* data_;
  std::size_t size_;
  mutable UniqueFd fd_;  ///< made when asked for
};

}  // namespace palpate::test
