/// Writers of traced lines, chosen by the file's ending: .vtp, .tck, .trk, .trx, .csv. Written under a temporary
/// name and renamed, so an output is never half a file.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "common/geometry/line.h"
#include "common/geometry/tractogram.h"

namespace palpate {

/// Checks that `path` has a known ending, may be written, and does not exist unless `overwrite`; call it
/// before the work starts.
/// @throws Error (usage, or work failed where the folder cannot be written).
void check_line_output(const std::filesystem::path& path, bool overwrite);

/// A further number for each point.
struct PointColumn {
  std::string name;
  std::vector<double> values;  ///< of all points, line after line
};

/// @param columns written by .vtp (point arrays), .trk (scalars, seven at most besides time, speed and error),
/// .trx and .csv; .tck has no place for them.
/// @param image that the lines belong to, for the header of a .trk; null: a grid is laid around them.
/// @throws Error as check_line_output(); (work failed) where the disk refuses.
void write_lines(const std::filesystem::path& path, const std::vector<Line>& lines, bool overwrite,
                 std::span<const PointColumn> columns = {}, const TractogramImage* image = nullptr);

}  // namespace palpate
