/// The layout of binary PLOT3D files, found from their size: nothing in such a file names its byte order,
/// its record marks, how many grids it holds, its precision or whether it has blanking (iblank).
///
/// Grid file:     [grids]  dimensions of every grid  { x y z [iblank] } of every grid
/// Solution file: [grids]  dimensions of every grid  { 4 conditions, 5 values a point } of every grid
/// `grids` is there in multi-grid files only; a Fortran program wraps each item in record marks (its byte
/// count before and after). P. P. Walatka et al., PLOT3D User's Manual, NASA TM-101067, 1990, ch. 8.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/math/vec.h"

namespace palpate {

struct Plot3dLayout {
  bool big_endian = false;
  bool record_marks = false;
  bool multi_grid = false;
  bool blanking = false;  ///< grid files
  bool double_precision = false;
  std::vector<Index3> grids;      ///< points along i, j, k of every grid
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

/// The layout under which the file's size fits its own dimensions, or nothing. Three-dimensional files only
/// (every dimension at least 2). Where several fit (rare), one whose first numbers are finite is taken.
/// Zeros after the data are allowed, up to kPlot3dTailBytes.
[[nodiscard]] std::optional<Plot3dLayout> find_plot3d_layout(const Plot3dBytes& bytes, Plot3dFile kind);

/// "big endian, 1 grid, single precision, no record marks, no blanking"
[[nodiscard]] std::string describe(const Plot3dLayout& layout, Plot3dFile kind);

}  // namespace palpate
