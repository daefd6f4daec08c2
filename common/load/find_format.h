/// Finding the format of a file or folder on disk, and reading the start of a file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>

#include "common/load/format.h"

namespace palpate {

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
