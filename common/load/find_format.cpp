#include "common/load/find_format.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <span>
#include <vector>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "common/base/error.h"
#include "common/base/files/unique_fd.h"
#include "common/base/index.h"
#include "common/load/gzip_head.h"
#include "common/load/header_of_pair.h"
#include "common/load/plot3d_layout.h"

namespace palpate {
namespace {

std::string lower_ending(const std::filesystem::path& path) {
  std::string ending = path.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](char c) { return static_cast<char>(std::tolower(static_cast<unsigned char>(c))); });
  return ending;
}

/// "a, b or c"
std::string either(const std::vector<std::string>& words) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (i > 0) text += i + 1 < words.size() ? ", " : " or ";
    text += words[i];
  }
  return text;
}

/// "a file of legacy VTK, VTK XML, ... or PLOT3D"
std::string readable() {
  std::vector<std::string> names;
  for (const FormatRow& row : format_rows()) {
    if (row.recognise != nullptr || !row.starts.empty()) names.emplace_back(row.name);
  }
  return "a file of " + either(names);
}

/// "a file, or the folder of an OpenFOAM case, ..."
std::string readable_folder() {
  std::vector<std::string> folders;
  for (const FormatRow& row : format_rows()) {
    if (row.recognise_folder != nullptr) folders.push_back("of " + std::string(row.folder));
  }
  return "a file, or the folder " + either(folders);
}

[[noreturn]] void refuse(const std::filesystem::path& path, const std::string& found,
                         const std::string& expected = "", const std::string& remedy = "") {
  throw input_error({path.string(), "", found, expected, remedy});
}

}  // namespace

HeadOfFile read_head(const std::filesystem::path& path, std::size_t bytes, std::size_t tail_bytes) {
  // O_NONBLOCK: opening a pipe must not wait for a writer.
  const UniqueFd fd(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY));
  if (!fd) {
    if (errno == ENOENT || errno == ENOTDIR) refuse(path, "no such file");
    refuse(path, std::string("cannot be read (") + errno_text() + ")", "", "check its permissions");
  }
  struct stat status {};
  if (::fstat(fd.get(), &status) != 0) refuse(path, std::string("cannot be read (") + errno_text() + ")");
  if (S_ISDIR(status.st_mode)) refuse(path, "is a folder", readable_folder());
  if (!S_ISREG(status.st_mode)) refuse(path, "is a pipe or device", "a regular file");

  HeadOfFile head;
  head.file_size = static_cast<std::uint64_t>(status.st_size);
  const auto read_part = [&](std::uint64_t offset, std::uint64_t count) {
    std::string part(count, '\0');
    std::size_t have = 0;
    while (have < part.size()) {
      const ssize_t got =
          ::pread(fd.get(), part.data() + have, part.size() - have, static_cast<off_t>(offset + have));
      if (got < 0 && errno == EINTR) continue;
      if (got < 0) refuse(path, std::string("cannot be read (") + errno_text() + ")");
      if (got == 0) break;
      have += as_size(got);
    }
    part.resize(have);
    return part;
  };
  head.bytes = read_part(0, std::min<std::uint64_t>(bytes, head.file_size));
  const std::uint64_t tail = std::min<std::uint64_t>(tail_bytes, head.file_size);
  head.tail = read_part(head.file_size - tail, tail);
  return head;
}

std::optional<std::filesystem::path> header_of_pair(const std::filesystem::path& path,
                                                    std::string_view head) {
  std::filesystem::path header = path;
  const bool packed = lower_ending(header) == ".gz";
  if (packed) header.replace_extension();
  if (lower_ending(header) != ".img") return std::nullopt;
  constexpr std::size_t kHeaderBytes = 348, kMark = 344;
  const std::string start =
      is_gzip(head) ? gzip_head(head, kHeaderBytes) : std::string(head.substr(0, kHeaderBytes));
  if (start.size() == kHeaderBytes && std::string_view(start).substr(kMark, 2) == "n+") return std::nullopt;
  const std::filesystem::path stem = std::filesystem::path(header).replace_extension();
  for (const char* ending : {".hdr", ".HDR", ".hdr.gz"}) {
    header = stem;
    header += ending;
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(header, ignored)) continue;
    const HeadOfFile found = read_head(header, kSniffBytes);
    const std::string bytes = is_gzip(found.bytes) ? gzip_head(found.bytes, kHeaderBytes) : found.bytes;
    // Those of other programs' .img files are text.
    constexpr std::array<std::string_view, 4> kSizes{
        std::string_view("\x5c\x01\0\0", 4), std::string_view("\0\0\x01\x5c", 4),
        std::string_view("\x1c\x02\0\0", 4), std::string_view("\0\0\x02\x1c", 4)};
    for (const std::string_view size : kSizes)
      if (bytes.starts_with(size)) return header;
  }
  return std::nullopt;
}

Format find_format(const std::filesystem::path& path) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) {
    for (const FormatRow& row : format_rows()) {
      if (row.recognise_folder != nullptr && row.recognise_folder(path)) return row.format;
    }
    refuse(path, "is a folder", readable_folder());
  }
  HeadOfFile head = read_head(path, kSniffBytes, kPlot3dTailBytes);
  std::string ending = lower_ending(path);
  for (const FormatRow& row : format_rows()) {
    if (row.marks.empty() || !names_ending(row, ending)) continue;
    const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : ".";
    if (row.recognise_folder(folder)) return row.format;
    refuse(path, "marks no folder of " + std::string(row.folder), std::string(row.marks) + " beside it");
  }
  if (ending == ".h5") ending = lower_ending(path.stem()) + ending;
  if (head.file_size == 0) refuse(path, "is empty", readable());
  if (const auto header = header_of_pair(path, head.bytes)) return find_format(*header);
  const bool packed = is_gzip(head.bytes);
  if (packed) {
    head.bytes = gzip_head(head.bytes, kSniffBytes);
    head.tail.clear();
    if (ending == ".gz") ending = lower_ending(path.stem());
  }
  const Sniffed sniffed = sniff(
      {std::as_bytes(std::span(head.bytes)), std::as_bytes(std::span(head.tail)), head.file_size, ending});
  if (packed && head.bytes.empty())
    refuse(path, "a gzip file of which nothing can be unpacked", "", "it may be cut off or damaged");
  if (packed && (!sniffed.format || !row_of(*sniffed.format).gzip)) {
    std::string of = sniffed.format ? std::string(row_of(*sniffed.format).name) : std::string();
    const bool known = sniffed.found.starts_with("a ") && sniffed.found != "a gzip file";
    if (known) of = sniffed.found;
    refuse(path, "a gzip file" + (of.empty() ? "" : " of " + of), readable(),
           known && !sniffed.remedy.empty() ? sniffed.remedy : "unpack it first");
  }
  // Of a kind that is known what to do comes first.
  const bool named = sniffed.found.starts_with("a ") || sniffed.found.starts_with("an ");
  if (!sniffed.format && named && !sniffed.remedy.empty())
    refuse(path, "is " + sniffed.found + ", which is not read", "", sniffed.remedy);
  if (!sniffed.format) refuse(path, sniffed.found, readable(), sniffed.remedy);
  return *sniffed.format;
}

}  // namespace palpate
