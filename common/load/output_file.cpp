#include "common/load/output_file.h"

#include <cerrno>
#include <cstdio>
#include <cstring>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "common/base/error.h"
#include "common/load/errno_text.h"

namespace palpate {
namespace {

constexpr std::size_t kBufferBytes = std::size_t{1} << 20;

std::filesystem::path folder_of(const std::filesystem::path& path) {
  return path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
}

[[noreturn]] void refuse_overwrite(const std::filesystem::path& path) {
  throw usage_error(path.string() + ": exists already; use --force to overwrite it");
}

}  // namespace

void check_output(const std::filesystem::path& path, bool overwrite) {
  struct stat status {};
  if (::lstat(path.c_str(), &status) == 0) {
    if (S_ISDIR(status.st_mode)) throw work_error(path.string() + ": is a folder");
    if (!S_ISREG(status.st_mode) && !S_ISLNK(status.st_mode))
      throw work_error(path.string() + ": is not a regular file");
    if (!overwrite) refuse_overwrite(path);
  }
  const std::filesystem::path folder = folder_of(path);
  if (::stat(folder.c_str(), &status) != 0 || !S_ISDIR(status.st_mode)) {
    throw work_error(path.string() + ": there is no folder " + folder.string());
  }
  if (::access(folder.c_str(), W_OK | X_OK) != 0) {
    throw work_error(path.string() + ": cannot write into its folder (" + errno_text() + ")");
  }
}

OutputFile::OutputFile(const std::filesystem::path& path, bool overwrite)
    : path_(path), overwrite_(overwrite) {
  check_output(path, overwrite);
  temporary_ =
      folder_of(path) / ("." + path.filename().string() + "." + std::to_string(::getpid()) + ".part");
  fd_.reset(::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC | O_NOFOLLOW, 0666));
  if (!fd_) refuse("cannot be created");
  buffer_.reserve(kBufferBytes);
}

OutputFile::~OutputFile() {
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
}

void OutputFile::refuse(const char* what) {
  throw work_error(path_.string() + ": " + what + " (" + errno_text() + ")");
}

void OutputFile::write(std::span<const std::byte> bytes) {
  buffer_.insert(buffer_.end(), bytes.begin(), bytes.end());
  if (buffer_.size() >= kBufferBytes) flush();
}

void OutputFile::flush() {
  std::size_t written = 0;
  while (written < buffer_.size()) {
    const ssize_t done = ::write(fd_.get(), buffer_.data() + written, buffer_.size() - written);
    if (done < 0 && errno == EINTR) continue;
    if (done < 0) refuse("cannot be written");
    written += static_cast<std::size_t>(done);
  }
  buffer_.clear();
}

void OutputFile::finish() {
  flush();
  // Some file systems tell of a full disk only here.
  if (::close(fd_.release()) != 0) refuse("cannot be written");
  if (overwrite_) {
    if (::rename(temporary_.c_str(), path_.c_str()) != 0) refuse("cannot be renamed into place");
  } else if (::renameat2(AT_FDCWD, temporary_.c_str(), AT_FDCWD, path_.c_str(), RENAME_NOREPLACE) != 0) {
    if (errno == EEXIST) refuse_overwrite(path_);
    // Not every file system knows the flag; the check at the start then has to do.
    if (errno != EINVAL || ::rename(temporary_.c_str(), path_.c_str()) != 0)
      refuse("cannot be renamed into place");
  }
  temporary_.clear();
}

}  // namespace palpate
