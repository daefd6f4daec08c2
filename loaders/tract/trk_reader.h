/// TrackVis files, versions 1 to 3: a header of 1000 bytes, then for each line its number of points, its
/// points with their scalars, and its properties. http://trackvis.org/docs/?subsect=fileformat
///
/// A stored position p [mm] counts from the corner of the first voxel along axes in the order of
/// `voxel_order`:
///   u_a = p_a / s_a - 1/2                                                                          (1)
/// is the index along axis a of that order. The axes of vox_to_ras may run otherwise: index b of its own
/// image is
///   v_b = u_a, or n_a - 1 - u_a where the two run against one another                              (2)
/// with a the axis of voxel_order that runs along the same axis of the head, as the axes of the matrix lie
/// nearest to. Then x = vox_to_ras v (RAS+). Where the two orders are one, as in files of nibabel, DIPY and
/// TrackVis, that is what nibabel reads, too, in all 48 orders. Of files whose header contradicts itself in this,
/// nibabel lays those with exchanged axes elsewhere: it counts n along the axes of the matrix, and turns by the
/// inverse where all three are exchanged around. A note says so.
///
/// Without a vox_to_ras (version 1, or programs that leave it zero) axes of the voxels' size along
/// voxel_order are taken, with the centre of the first voxel at the origin; a note says so.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "common/geometry/tractogram.h"

namespace palpate {

/// @param bytes of the whole file.
/// @param notes what the user should know of it.
/// @throws Error (bad input) with `file`: a header that is no TrackVis file's, counts that the file has no
/// room for, voxels without a size, axes that do not span space, points that are not finite.
[[nodiscard]] Tractogram read_trk(const std::string& file, std::string_view bytes,
                                  std::vector<std::string>& notes);

}  // namespace palpate
