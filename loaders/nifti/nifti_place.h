/// Where the voxels of a NIfTI image lie: its sform, else its qform, else its spacings, in RAS+ millimetres.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <nifti/nifti2_io.h>

#include "common/field/data_set.h"
#include "loaders/nifti/nifti_check.h"

namespace palpate {

struct NiftiPlace {
  UniformTopology topology;
  bool anatomical = false;         ///< the header says where right, front and up are
  std::vector<std::string> notes;  ///< what was taken, and what was not
};

/// A form that is not finite, or spans no volume, is left aside for the other one.
/// @param qform the fields of the header's. @param left_handed images that state no orientation run from right to left; none: nobody was asked.
/// @throws Error (bad input) with `file` where the axes span no volume.
[[nodiscard]] NiftiPlace place_nifti(const nifti_image& image, const NiftiQform& qform,
                                     std::optional<bool> left_handed, const std::string& file);

}  // namespace palpate
