/// What gzip and zlib data hold: their start, to find a format and to check a header before a reader sees it, or
/// as much as there is room for.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
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

struct Unpacked {
  std::uint64_t bytes = 0;  ///< written
  bool ended = false;       ///< the data end there, and their checksum is right
  bool more = false;        ///< there are more than there was room for
};
/// Unpacks gzip (one member or several) or zlib data.
[[nodiscard]] Unpacked unpack(std::string_view packed, std::span<std::byte> out);

}  // namespace palpate
