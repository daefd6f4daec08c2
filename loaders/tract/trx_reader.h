/// TRX: a folder, or a zip file of one, of bare arrays whose names state their shape and type. Little endian.
/// https://tee-ar-ex.github.io, specification 0.1
///
///   header.json            NB_VERTICES, NB_STREAMLINES, VOXEL_TO_RASMM, DIMENSIONS
///   positions.3.float16    RAS+ mm, three numbers a point
///   offsets.uint64         first point of each line; with or without a last entry for the end
///   dpv/fa.float32         numbers for each point ("data per vertex")
///   dps/seed.3.float32     for each line ("per streamline"); 3: components
///   groups/left.uint32     lines of a group: kept as a column "group left" of ones and zeros
/// Numbers of whole groups (dpg/) are left out, which a note says.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "common/geometry/tractogram.h"

namespace palpate {

/// @throws Error (bad input) with the path: a member is missing, of an unknown type, or of another size than
/// the header claims; offsets that do not increase; points that are not finite.
[[nodiscard]] Tractogram read_trx(const std::filesystem::path& path, std::vector<std::string>& notes);

}  // namespace palpate
