/// A cheap look at a NRRD header before Teem sees it: what the header claims must fit into the data that is
/// there, since Teem allocates what the header claims, and data files must be regular files.
///
/// Format: "Definition of NRRD File Format", teem.sourceforge.net/nrrd/format.html.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/field/data_set.h"

namespace palpate {

/// The fields that say how many bytes there are and where.
struct NrrdClaims {
  std::vector<std::uint64_t> sizes;  ///< samples along every axis, the fastest first
  std::uint64_t bytes_per_value = 0;
  std::optional<ScalarType> type;  ///< of the values; none: not read yet
  std::string encoding = "raw";
  bool detached = false;
  std::vector<std::string> data_files;         ///< as the header names them
  bool skips = false;                          ///< lines or bytes before the values are left out
  std::uint64_t line_skip = 0, byte_skip = 0;  ///< of each file, lines first
  bool from_end = false;  ///< the values are found from the end of the file, whatever stands before them
  std::uint64_t header_bytes = 0;  ///< where attached data begins
  std::string problem;             ///< what is wrong, or empty
};

/// Reads the claims from the start of a NRRD file. Unknown fields are Teem's business.
[[nodiscard]] NrrdClaims read_nrrd_claims(std::string_view head);

/// Why data of `available` bytes cannot hold what `claims` says, or empty.
[[nodiscard]] std::string nrrd_size_problem(const NrrdClaims& claims, std::uint64_t available);

/// The numbers of a text, parted by blanks, with commas before or behind them: how many of `wanted` there are, and the
/// first that the type does not hold as it is written. Teem takes a word for what it begins with.
struct NrrdWords {
  std::uint64_t count = 0;           ///< `wanted` + 1 where a number follows those
  std::optional<std::string> wrong;  ///< its place is `count`, and none behind it were counted
};
[[nodiscard]] NrrdWords words_of(std::string_view text, ScalarType type, std::uint64_t wanted);

/// @throws Error (bad input).
/// @return what the user should know of data beyond what the header claims, or empty.
std::string check_nrrd(const std::string& file);

/// One sentence where the gzip data from byte `first` of the file on unpacks to more than `wanted` bytes, or
/// other bytes follow it; else empty. The size that the data states at its end is believed where it is
/// `wanted`; otherwise the data is unpacked, `wanted` bytes and a little more of it at most.
[[nodiscard]] std::string gzip_rest(const std::filesystem::path& file, std::uint64_t first,
                                    std::uint64_t wanted);

}  // namespace palpate
