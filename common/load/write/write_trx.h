/// TRX, the tractography exchange format (https://github.com/tee-ar-ex/trx-spec): a zip file of plain arrays, stored as
/// they are.
///
///   header.json           VOXEL_TO_RASMM, DIMENSIONS, NB_VERTICES, NB_STREAMLINES
///   positions.3.float32   RAS+ mm
///   offsets.uint64        of each line's first point, and the number of points
///   dpv/NAME.float32      Tractogram::of_points
///   dps/NAME.float32      Tractogram::of_lines
///   groups/NAME.uint32    the lines at which a column "group NAME" of lines is not zero, as readers here name groups
#pragma once

#include "common/base/files/output_file.h"
#include "common/geometry/tractogram.h"

namespace palpate {

/// Without an image the header has one voxel of a millimetre at the origin.
/// @throws Error (work failed) for four gigabytes and more, which plain zip files do not hold.
void write_trx(OutputFile& file, const Tractogram& lines);

}  // namespace palpate
