/// Where the voxels of a NIfTI image lie: its sform, else its qform, else its spacings, in RAS+ millimetres.
#pragma once

#include <string>
#include <vector>

#include <nifti/nifti2_io.h>

#include "common/field/data_set.h"

namespace palpate {

struct NiftiPlace {
  UniformTopology topology;
  bool anatomical = false;         ///< the header says where right, front and up are
  std::vector<std::string> notes;  ///< what was taken, and what was not
};

/// @param left_handed images that state no orientation run from right to left.
/// @throws Error (bad input) with `file` where the axes span no volume.
[[nodiscard]] NiftiPlace place_nifti(const nifti_image& image, bool left_handed, const std::string& file);

}  // namespace palpate
