/// The layout of PLOT3D files, found from their size: nothing in such a file names its byte order, its record
/// marks, how many grids it holds, its precision, whether it has blanking (iblank) or is two-dimensional.
///
/// Grid file:     [grids]  dimensions of every grid  { x y z [iblank] } of every grid
/// Solution file: [grids]  dimensions of every grid  { 4 conditions, 5 values a point } of every grid
/// Two-dimensional files have two dimensions a grid, no z, and 4 values a point. Text files hold the same
/// numbers, separated by blanks or commas, as Fortran writes them (1.5D0, "75*0.3" for 75 of them). `grids` is there in multi-grid files only; a Fortran program wraps each item
/// in record marks (its byte count before and after). P. P. Walatka et al., PLOT3D User's Manual, NASA
/// TM-101067, 1990, ch. 8.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "common/math/vec.h"

namespace palpate {

struct Plot3dLayout {
  bool big_endian = false;
  bool record_marks = false;
  bool multi_grid = false;
  bool blanking = false;  ///< grid files
  bool double_precision = false;
  bool text = false;  ///< numbers as text: no byte order, no record marks, double precision
  bool two_dimensional = false;
  std::vector<Index3> grids;      ///< points along i, j, k of every grid; k has 1 in two dimensions
  std::uint64_t data_offset = 0;  ///< of the first coordinate, or of the first condition
};

enum class Plot3dFile : std::uint8_t { kGrid, kSolution };

/// What a reader of bytes needs to know of a file: its size and some bytes of it.
struct Plot3dBytes {
  std::span<const std::byte> head;  ///< from the start of the file, up to kPlot3dHeadBytes
  std::span<const std::byte> tail;  ///< the end of the file, up to kPlot3dTailBytes
  std::uint64_t file_size = 0;
};
/// Enough for the dimensions of some five thousand grids.
inline constexpr std::size_t kPlot3dHeadBytes = std::size_t{64} << 10;
/// Some programs pad their files with zeros, up to this.
inline constexpr std::size_t kPlot3dTailBytes = 4096;

/// The layout under which a binary file's size fits its own dimensions (each at least 2), or nothing. Where
/// several fit (rare), one whose first numbers are finite is taken, and three dimensions before two. Zeros
/// after the data are allowed in three dimensions, up to kPlot3dTailBytes.
[[nodiscard]] std::optional<Plot3dLayout> find_plot3d_layout(const Plot3dBytes& bytes, Plot3dFile kind);

/// Whether the head of a file could be that of a PLOT3D text file: nothing but numbers, the first of them
/// dimensions for which the file is neither too short nor far too long.
[[nodiscard]] bool may_be_plot3d_text(const Plot3dBytes& bytes, Plot3dFile kind);

/// The layout under which the count of numbers in `text`, the whole file, fits its own dimensions, or
/// nothing: also where a word is no number, or more are repeated than 2^24 beside the file's size.
[[nodiscard]] std::optional<Plot3dLayout> find_plot3d_text_layout(std::string_view text, Plot3dFile kind);

/// The same file, text or binary, in one layout: binary of this machine's byte order, double precision, several grids, no
/// record marks.
/// @pre `layout` was found in `file`, the whole of it.
[[nodiscard]] std::string plot3d_bytes(std::string_view file, const Plot3dLayout& layout, Plot3dFile kind);

/// "big endian, 1 grid, single precision, no record marks, no blanking"
[[nodiscard]] std::string describe(const Plot3dLayout& layout, Plot3dFile kind);

}  // namespace palpate
