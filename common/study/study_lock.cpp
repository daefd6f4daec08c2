#include "common/study/study_lock.h"

#include <array>
#include <cerrno>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include "common/base/error.h"
#include "common/base/text.h"
#include "common/study/study_disk.h"

namespace palpate {
namespace {

namespace fs = std::filesystem;

UniqueFd lock_file(const fs::path& file) {
  make_study_folder(file.parent_path());
  UniqueFd fd(::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644));
  if (!fd) throw work_error(file.string() + ": cannot be made (" + errno_text() + ")");
  return fd;
}

/// False where another program has it and `how` does not wait.
bool locked(const UniqueFd& fd, int how, const fs::path& file) {
  int result = 0;
  do result = ::flock(fd.get(), how);
  while (result != 0 && errno == EINTR);
  if (result != 0 && errno != EWOULDBLOCK)
    throw work_error(file.string() + ": cannot be locked (" + errno_text() + ")");
  return result == 0;
}

}  // namespace

StudyLock::StudyLock(const fs::path& file, Kind kind, const std::string& by) : fd_(lock_file(file)) {
  if (!locked(fd_, (kind == Kind::kShared ? LOCK_SH : LOCK_EX) | LOCK_NB, file)) {
    std::array<char, 256> text{};
    const ssize_t got = ::pread(fd_.get(), text.data(), text.size(), 0);
    const std::string holder(text.data(), got > 0 ? static_cast<std::size_t>(got) : 0);
    throw usage_error("the experiment is in use by " +
                      (holder.empty() ? std::string("another program") : printable(holder)) +
                      "; wait until it has ended");
  }
  if (::ftruncate(fd_.get(), 0) == 0) {
    const std::string text = by + " (process " + std::to_string(::getpid()) + ")";
    (void)::pwrite(fd_.get(), text.data(), text.size(), 0);  // only what others are told
  }
}

StudyLock::StudyLock(const fs::path& file) : fd_(lock_file(file)) { (void)locked(fd_, LOCK_EX, file); }

}  // namespace palpate
