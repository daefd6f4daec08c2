/// Text for readers that want a file.
#pragma once

#include <string>

#include <sys/mman.h>
#include <unistd.h>

#include "common/base/error.h"
#include "common/base/files/unique_fd.h"
#include "common/base/index.h"

namespace palpate {

/// Text under the name of a file that is in memory alone.
class MemoryText {
 public:
  /// Also in place of what was written before. @returns the name. @throws Error (work).
  std::string write(const std::string& text) {
    file_ = UniqueFd(::memfd_create("text", MFD_CLOEXEC));
    for (std::size_t at = 0; at < text.size();) {
      const ssize_t count = file_.get() < 0 ? -1 : ::write(file_.get(), text.data() + at, text.size() - at);
      if (count <= 0) throw work_error("no memory for a file's text");
      at += as_size(count);
    }
    return "/proc/self/fd/" + std::to_string(file_.get());
  }

 private:
  UniqueFd file_;
};

}  // namespace palpate
