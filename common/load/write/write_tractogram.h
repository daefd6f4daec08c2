/// Writers of tractograms, chosen by the file's ending: .tck, .trk, .trx, .vtp, .csv. Written under a temporary
/// name and renamed, so an output is never half a file.
///
///   .tck  MRtrix tracks: positions alone, world millimetres
///   .trk  TrackVis, version 2: positions from the corner of the image's first voxel along its axes; up to
///   ten
///         numbers for each point and for each line
///   .trx  write_trx.h: everything
///   .vtp  VTK XML: everything
///   .csv  a row a point: line, point, x, y, z, its numbers, and those of its line
#pragma once

#include <filesystem>
#include <string>

#include "common/base/files/output_file.h"
#include "common/geometry/tractogram.h"

namespace palpate {

/// Call check_line_output() (write_lines.h), which knows the same endings, before the work starts.
/// @throws Error (usage) for another ending, (work failed) where the disk refuses or the format cannot hold
/// the lines.
void write_tractogram(const std::filesystem::path& path, const Tractogram& lines, bool overwrite);

/// ".tck" of "A.TCK".
[[nodiscard]] std::string lower_ending(const std::filesystem::path& path);

/// @name The bytes of one format
/// @{
void write_tck(OutputFile& file, const Tractogram& lines);
/// Without an image the lines are put into one of unit voxels at the origin.
void write_trk(OutputFile& file, const Tractogram& lines);
/// @}

}  // namespace palpate
