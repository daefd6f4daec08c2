/// Coarser volumes of the same place: what is around a lens need not be as fine as what is in it (Ikits 2006,
/// sec. 5.7.3).
#pragma once

#include <memory>

#include "common/render/volume/voxels/volume_image.h"

namespace palpate {

/// An axis of n > 2 points becomes one of n / 2 + 1, `level` times over, between the same ends; shorter ones
/// stay. With s the ratio of the spacings, the number at a coarse point is the mean of the finite ones less
/// than s points away, weighted by 1 - distance / s, axis by axis; it is NaN where the nearest one is.
/// Numbers keep their type, and the image its range. Colours are left out.
/// @pre level > 0.
[[nodiscard]] std::shared_ptr<const VolumeImage> coarse_image(const VolumeImage& image, int level);

}  // namespace palpate
