/// SHA-256 (FIPS 180-4): the checksum by which a session knows its input; `sha256sum` prints the same.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "common/base/progress.h"

namespace palpate {

/// 64 hexadecimal digits.
[[nodiscard]] std::string sha256_of(std::string_view bytes);

/// Checksum of several runs of bytes and of `words`, which threads share among them: SHA-256 of the words,
/// the runs' sizes and the checksums of their pieces of 4 MB. It is none of `sha256sum`'s.
/// @param threads as parallel_for(); they change nothing.
[[nodiscard]] std::string sha256_in_pieces(std::span<const std::string_view> runs, std::string_view words,
                                           int threads);

/// Checksum of a file's content.
/// @throws Error (bad input) where it cannot be read; Cancelled.
[[nodiscard]] std::string sha256_of_file(const std::filesystem::path& file,
                                         const Progress* progress = nullptr);

}  // namespace palpate
