/// What a gzip file holds beyond what is read of it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace palpate {

/// One sentence where the gzip data from byte `first` of the file on unpacks to more than `wanted` bytes, or
/// other bytes follow it; else empty. The size that the data states at its end is believed where it is
/// `wanted`; otherwise the data is unpacked, `wanted` bytes and a little more of it at most.
[[nodiscard]] std::string gzip_rest(const std::filesystem::path& file, std::uint64_t first,
                                    std::uint64_t wanted);

}  // namespace palpate
