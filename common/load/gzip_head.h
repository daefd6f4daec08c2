/// The start of what a gzip file holds, to find its format and to check its header before a reader sees it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace palpate {

/// How far deflate compresses at best: a claim of more than that times a gzip file's bytes is a lie.
inline constexpr std::uint64_t kGzipRatio = 1032;

/// Whether `bytes` begin as a gzip file does (RFC 1952).
[[nodiscard]] bool is_gzip(std::string_view bytes) noexcept;

/// Unpacks the start of a gzip file, at most `most` bytes; fewer where `compressed` ends before or is
/// damaged.
[[nodiscard]] std::string gzip_head(std::string_view compressed, std::size_t most);

}  // namespace palpate
