/// A cheap look at a MetaImage header before MetaIO sees it: what the header claims must fit into the data
/// that is there, since MetaIO allocates what the header claims and has room for ten axes.
///
/// Format: "MetaIO: medical image input/output", itk.org/Wiki/ITK/MetaIO/Documentation.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

namespace palpate {

/// The fields that say how many bytes there are and where.
struct MetaClaims {
  std::array<std::uint64_t, 3> size{1, 1, 1};
  std::uint64_t bytes_per_voxel = 0;  ///< of all channels
  bool binary = true;
  bool compressed = false;
  std::uint64_t compressed_bytes = 0;  ///< 0: not stated
  std::int64_t skip = 0;               ///< bytes before the voxels; -1: they are the last of their file
  std::string data_file;               ///< empty: the voxels follow the header
  std::uint64_t header_bytes = 0;
  std::string problem;  ///< what is wrong, or empty
};

/// Reads the claims from the start of a file. Unknown fields are MetaIO's business.
[[nodiscard]] MetaClaims read_meta_claims(std::string_view head);

/// Why data of `available` bytes cannot hold what `claims` says, or empty.
[[nodiscard]] std::string meta_size_problem(const MetaClaims& claims, std::uint64_t available);

/// @throws Error (bad input).
void check_meta(const std::string& file);

/// Unpacks compressed voxels without keeping them: MetaIO takes a stream that breaks off for a whole one.
/// @throws Error (bad input) where there are fewer than the header claims.
void check_meta_stream(const std::string& file);

}  // namespace palpate
