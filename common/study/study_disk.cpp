#include "common/study/study_disk.h"

#include <cerrno>
#include <cstdio>
#include <fstream>
#include <sstream>
#include <vector>

#include <fcntl.h>
#include <unistd.h>

#include "common/base/files/unique_fd.h"
#include "common/base/text.h"

namespace palpate {
namespace {

namespace fs = std::filesystem;

bool all_written(const UniqueFd& fd, const std::string& text) {
  for (std::size_t at = 0; at < text.size();) {
    const ssize_t got = ::write(fd.get(), text.data() + at, text.size() - at);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return false;
    at += static_cast<std::size_t>(got);
  }
  return true;
}

void keep_folder(const fs::path& path) {
  const UniqueFd folder(::open(path.empty() ? "." : path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (!folder || ::fsync(folder.get()) != 0)
    throw work_error(path.string() + ": cannot be written (" + errno_text() + ")");
}

}  // namespace

std::string read_study_text(const fs::path& path) {
  constexpr std::uintmax_t kMost = std::uintmax_t{1} << 26U;
  std::ifstream in(path, std::ios::binary);
  if (!in) throw input_error({path.string(), "", "cannot be read (" + errno_text() + ")", "", ""});
  std::error_code unknown;
  if (fs::file_size(path, unknown) > kMost || unknown)
    throw input_error({path.string(), "", "it is no file or too large", "up to " + bytes_text(kMost),
                       "restore it from a copy"});
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

Json read_study_json(const fs::path& path) {
  Json json = parse_json(read_study_text(path));
  if (!json.is_object())
    throw input_error({path.string(), "", "it holds no JSON object", "", "restore it from a copy"});
  return json;
}

std::int64_t whole_number(const fs::path& path, const Json& json, const char* key, std::int64_t least,
                          std::int64_t most) {
  const Json& value = json.at(key);
  const bool whole = value.is_number_integer() &&
                     !(value.is_number_unsigned() && value.get<std::uint64_t>() > INT64_MAX) &&
                     value.get<std::int64_t>() >= least && value.get<std::int64_t>() <= most;
  if (!whole)
    throw input_error({path.string(), key, value.dump(),
                       "a whole number from " + std::to_string(least) + " to " + std::to_string(most),
                       "restore it from a copy"});
  return value.get<std::int64_t>();
}

bool is_second(const fs::path& path, const Json& json, const char* key, std::string_view first,
               std::string_view second) {
  const Json& value = json.at(key);
  const std::string word = value.is_string() ? value.get<std::string>() : std::string();
  if (word != first && word != second)
    throw input_error({path.string(), key, value.dump(), std::string(first) + " or " + std::string(second),
                       "restore it from a copy"});
  return word == second;
}

void write_safely(const fs::path& path, const std::string& text) {
  const fs::path temporary = path.string() + ".part";
  const UniqueFd file(::open(temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644));
  if (!file || !all_written(file, text) || ::fsync(file.get()) != 0 ||
      std::rename(temporary.c_str(), path.c_str()) != 0)
    throw work_error(path.string() + ": cannot be written (" + errno_text() + ")");
  keep_folder(path.parent_path());
}

void make_study_folder(const fs::path& path) {
  std::error_code error;
  std::vector<fs::path> made;  // innermost first
  for (fs::path at = path; !at.empty() && !fs::exists(at, error); at = at.parent_path()) made.push_back(at);
  fs::create_directories(path, error);
  if (error) throw work_error(path.string() + ": cannot be made (" + error.message() + ")");
  for (auto at = made.rbegin(); at != made.rend(); ++at) keep_folder(at->parent_path());
}

}  // namespace palpate
