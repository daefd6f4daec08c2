/// The part of the panel that shows and changes the region of interest of a volume.
#pragma once

#include <string>

#include "common/render/volume/voxels/volume_image.h"
#include "common/window/controls/region_control.h"

namespace palpate {

/// What the user asked for in this frame.
struct RegionActions {
  std::string crop;  ///< ending of the file to write what is in the box to: ".nii.gz"; empty: nothing
};

/// Changes `region` as the user does.
[[nodiscard]] RegionActions edit_region(RegionControl& region, const VolumeImage& image);

}  // namespace palpate
