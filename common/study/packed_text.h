/// Text as gzip has it, in memory.
#pragma once

#include <string>
#include <string_view>

#include "common/servo/recording.h"

namespace palpate {

/// @throws Error (work failed) where memory does not suffice.
[[nodiscard]] std::string packed(std::string_view text);
/// Of a file. @throws Error (bad input) where it cannot be read, is damaged, or unpacks to more than `most` bytes.
[[nodiscard]] std::string unpacked_file(const std::string& file, std::size_t most = std::size_t{1} << 30U);
/// A recording (servo/recording.h) that was packed. @throws Error (bad input).
[[nodiscard]] Recording read_packed_recording(const std::string& file);

}  // namespace palpate
