#include "common/base/files/output_file.h"

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <mutex>
#include <optional>
#include <system_error>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "common/base/error.h"
#include "common/base/files/kept_files.h"
#include "common/base/index.h"
#include "common/base/ledger.h"
#include "common/base/text.h"

namespace palpate {
namespace {

constexpr std::size_t kBufferBytes = std::size_t{1} << 20;

std::filesystem::path folder_of(const std::filesystem::path& path) {
  return path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
}

[[noreturn]] void refuse_overwrite(const std::filesystem::path& path) {
  throw usage_error(path.string() + ": exists already; use --force to overwrite it");
}

constexpr std::string_view kPartEnding = ".part";

std::string part_start(const std::filesystem::path& path) { return "." + path.filename().string() + "."; }

/// The process that made the temporary file `name` of an output whose parts begin with `start`.
std::optional<pid_t> maker_of(std::string_view name, std::string_view start) {
  if (!name.starts_with(start) || !name.ends_with(kPartEnding)) return std::nullopt;
  name.remove_prefix(start.size());
  if (name.size() <= kPartEnding.size()) return std::nullopt;
  name.remove_suffix(kPartEnding.size());
  const std::optional<pid_t> pid = parsed<pid_t>(name);
  return pid && *pid > 0 ? pid : std::nullopt;
}

/// Removes what programs that are gone left of `path`.
void remove_stale_parts(const std::filesystem::path& path) {
  const std::string start = part_start(path);
  std::error_code error;
  std::vector<std::filesystem::path> stale;
  for (auto it = std::filesystem::directory_iterator(folder_of(path), error);
       !error && it != std::filesystem::directory_iterator(); it.increment(error)) {
    const auto pid = maker_of(it->path().filename().string(), start);
    if (pid && ::kill(*pid, 0) != 0 && errno == ESRCH) stale.push_back(it->path());
  }
  for (const auto& part : stale) ::unlink(part.c_str());
}

/// Temporary files at work in this process.
struct UnfinishedOutputs {
  std::mutex mutex;
  std::vector<std::filesystem::path> parts;

  void add(const std::filesystem::path& part) {
    const std::lock_guard lock(mutex);
    parts.push_back(part);
  }
  void drop(const std::filesystem::path& part) {
    const std::lock_guard lock(mutex);
    std::erase(parts, part);
  }
};

UnfinishedOutputs& unfinished_outputs() {
  static UnfinishedOutputs outputs;
  return outputs;
}

/// What keep_from_outputs() was told.
struct KeptFiles {
  std::mutex mutex;
  std::vector<std::filesystem::path> files;
};

KeptFiles& kept_files() {
  static KeptFiles kept;
  return kept;
}

/// @throws Error (usage) where `path` is one of them.
void refuse_kept(const std::filesystem::path& path) {
  KeptFiles& kept = kept_files();
  const std::lock_guard lock(kept.mutex);
  for (const std::filesystem::path& file : kept.files) {
    std::error_code ignored;
    if (std::filesystem::equivalent(path, file, ignored))
      throw usage_error(path.string() + " is the input " + file.string() + "; give the output another name");
  }
}

}  // namespace

void keep_from_outputs(std::span<const std::filesystem::path> files) {
  KeptFiles& kept = kept_files();
  const std::lock_guard lock(kept.mutex);
  for (const std::filesystem::path& file : files) {
    std::error_code ignored;
    if (!file.empty() && std::filesystem::is_regular_file(file, ignored)) kept.files.push_back(file);
  }
}

void remove_unfinished_outputs() noexcept {
  UnfinishedOutputs& outputs = unfinished_outputs();
  const std::lock_guard lock(outputs.mutex);
  for (const auto& part : outputs.parts) ::unlink(part.c_str());
}

void check_output(const std::filesystem::path& path, bool overwrite) {
  struct stat status {};
  if (::lstat(path.c_str(), &status) == 0) {
    if (S_ISDIR(status.st_mode)) throw work_error(path.string() + ": is a folder");
    if (!S_ISREG(status.st_mode) && !S_ISLNK(status.st_mode))
      throw work_error(path.string() + ": is not a regular file");
    refuse_kept(path);
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
  remove_stale_parts(path);
  temporary_ = folder_of(path) / (part_start(path) + std::to_string(::getpid()) + std::string(kPartEnding));
  fd_.reset(::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC | O_NOFOLLOW, 0666));
  if (!fd_) refuse("cannot be created");
  unfinished_outputs().add(temporary_);
  buffer_.reserve(kBufferBytes);
}

OutputFile::~OutputFile() {
  if (temporary_.empty()) return;
  ::unlink(temporary_.c_str());
  unfinished_outputs().drop(temporary_);
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
    written += as_size(done);
  }
  buffer_.clear();
}

void OutputFile::finish() {
  flush();
  const auto bytes = static_cast<std::uint64_t>(std::max<off_t>(0, ::lseek(fd_.get(), 0, SEEK_CUR)));
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
  unfinished_outputs().drop(temporary_);
  temporary_.clear();
  Ledger::enter("file " + path_.string(), "written", 1e3 * watch_.seconds(), bytes);
}

bool may_cache_beside(const std::filesystem::path& path) {
  const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : ".";
  struct stat status {};
  return ::stat(folder.c_str(), &status) == 0 && S_ISDIR(status.st_mode) &&
         (status.st_mode & (S_IWUSR | S_IWGRP | S_IWOTH)) != 0 && ::access(folder.c_str(), W_OK | X_OK) == 0;
}

}  // namespace palpate
