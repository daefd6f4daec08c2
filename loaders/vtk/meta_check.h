/// A cheap look at a MetaImage header before MetaIO sees it: what the header claims must fit into the data
/// that is there, since MetaIO allocates what the header claims and has room for ten axes.
///
/// Format: "MetaIO: medical image input/output", itk.org/Wiki/ITK/MetaIO/Documentation.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace palpate {

/// The fields that say how many bytes there are and where.
struct MetaClaims {
  std::array<std::uint64_t, 3> size{1, 1, 1};
  std::uint64_t bytes_per_voxel = 0;  ///< of all channels
  bool binary = true;
  bool compressed = false;
  std::uint64_t compressed_bytes = 0;  ///< 0: not stated
  std::int64_t skip = 0;               ///< bytes before the voxels; -1: they are the last of their file
  std::string data_file;               ///< empty: the voxels follow the header, or lie in `pieces`
  /// Files one after the other along the last axes: those of a list (ElementDataFile = LIST [D], each of D
  /// axes) or numbered ones (file%03d.raw FIRST LAST STEP).
  std::vector<std::string> pieces;
  std::uint64_t piece_count = 0;  ///< that the axes ask for; 0: the voxels are not in pieces
  std::uint64_t header_bytes = 0;
  std::string problem;  ///< what is wrong, or empty
};

/// Reads the claims from the start of a file. Unknown fields are MetaIO's business.
[[nodiscard]] MetaClaims read_meta_claims(std::string_view head);

/// Why data of `available` bytes cannot hold what `claims` says, or empty.
[[nodiscard]] std::string meta_size_problem(const MetaClaims& claims, std::uint64_t available);

/// Voxels of pieces are checked piece by piece: each holds as many bytes as it has to, and no others but
/// those that HeaderSize passes over.
/// @throws Error (bad input).
void check_meta(const std::string& file);

/// The voxels of the pieces that `file` names, as they stand there; nothing where it names none. MetaIO is
/// not asked: it hands the name of numbered files to printf.
/// @throws Error (bad input) as check_meta().
[[nodiscard]] std::vector<std::byte> read_meta_pieces(const std::string& file);

/// Unpacks compressed voxels without keeping them: MetaIO takes a stream that breaks off for a whole one.
/// @throws Error (bad input) where there are fewer than the header claims.
void check_meta_stream(const std::string& file);

}  // namespace palpate
