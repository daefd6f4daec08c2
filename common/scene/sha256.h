/// SHA-256 (FIPS 180-4): the checksum by which a session knows its input; `sha256sum` prints the same.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "common/base/progress.h"

namespace palpate {

/// 64 hexadecimal digits.
[[nodiscard]] std::string sha256_of(std::string_view bytes);

/// Checksum of a file's content.
/// @throws Error (bad input) where it cannot be read; Cancelled.
[[nodiscard]] std::string sha256_of_file(const std::filesystem::path& file,
                                         const Progress* progress = nullptr);

}  // namespace palpate
