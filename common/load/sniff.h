/// Finding a file's format by what is in it; its ending only breaks ties.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "common/load/format.h"

namespace palpate {

/// How many bytes from the start of a file sniff() looks at.
inline constexpr std::size_t kSniffBytes = std::size_t{64} << 10;

/// What is known of a file before any loader sees it.
struct FileHead {
  std::span<const std::byte> bytes;  ///< the first kSniffBytes, or all
  std::span<const std::byte> tail;   ///< the last kPlot3dTailBytes, or all
  std::uint64_t file_size = 0;
  std::string_view ending;  ///< lower case with its dot: ".vtk", ".gz"
};

struct Sniffed {
  std::optional<Format> format;
  std::string found;   ///< where there is no format: what the file looks like ("a gzip file")
  std::string remedy;  ///< and what could be done
};

/// Pure: looks at nothing but its argument.
[[nodiscard]] Sniffed sniff(const FileHead& head);

/// The format of a file or folder on disk. Opens regular files only: a pipe or device is refused unread.
/// @throws Error (bad input) naming the path: missing, unreadable, empty, not a regular file, unknown.
[[nodiscard]] Format find_format(const std::filesystem::path& path);

/// The first and last bytes of a regular file and its size, for find_format() and the loaders' own checks.
struct HeadOfFile {
  std::string bytes;
  std::string tail;
  std::uint64_t file_size = 0;
};
/// @throws Error (bad input) as find_format() does, except for an empty file.
[[nodiscard]] HeadOfFile read_head(const std::filesystem::path& path, std::size_t bytes,
                                   std::size_t tail_bytes = 0);

}  // namespace palpate
