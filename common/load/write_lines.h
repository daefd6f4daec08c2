/// Writers of traced lines, chosen by the file's ending: .vtp, .tck, .trk, .csv. Written under a temporary
/// name and renamed, so an output is never half a file.
#pragma once

#include <filesystem>
#include <vector>

#include "common/geometry/line.h"

namespace palpate {

/// Checks that `path` has a known ending, may be written, and does not exist unless `overwrite`; call it
/// before the work starts.
/// @throws Error (usage, or work failed where the folder cannot be written).
void check_line_output(const std::filesystem::path& path, bool overwrite);

/// @throws Error as check_line_output(); (work failed) where the disk refuses.
void write_lines(const std::filesystem::path& path, const std::vector<Line>& lines, bool overwrite);

}  // namespace palpate
