/// Reading tractograms of any format: .tck, .trk, .trx, and lines in VTK's files (.vtp, .vtk). A helper
/// program reads the file (load.h); what it hands over is packed here.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "common/base/progress.h"
#include "common/field/data_set.h"
#include "common/geometry/tractogram.h"
#include "common/load/load.h"

namespace palpate {

/// A tractogram and what its file says of it.
struct TractogramFile {
  Tractogram lines;  ///< RAS+ mm; of VTK's files, which do not state a frame, the coordinates as stored
  FileInfo info;
};

/// Whether the file holds lines and no volume, as far as its description tells (VTK's polygonal data may
/// prove to be surfaces when it is read).
[[nodiscard]] bool may_hold_lines(const FileInfo& info) noexcept;

/// Opens and reads a file with all numbers of points and lines.
/// @throws Error (bad input): not readable, or it holds no lines; Cancelled.
[[nodiscard]] TractogramFile read_tractogram(const std::filesystem::path& file, Progress* progress = nullptr);

/// Packs the lines of `blocks`, which a Source read: cells of any other kind are left out. An array of
/// several components becomes as many columns ("color 1", "color 2", …).
[[nodiscard]] Tractogram pack_lines(std::span<const DataSet> blocks);

}  // namespace palpate
