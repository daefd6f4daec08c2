/// An image of diffusion tensors as a volume: fractional anisotropy, with main directions as colours.
#pragma once

#include <memory>

#include "common/field/transfer/color_transfer.h"
#include "common/render/tensor/tensor_voxels.h"
#include "common/render/volume/voxels/volume_image.h"

namespace palpate {

/// FA at the centres of the voxels, 0 where there is no tensor; colours are direction_color() of the main
/// eigenvectors, at full strength: how strong a direction is, opacity says. Shares the numbers of `voxels`.
[[nodiscard]] std::shared_ptr<const VolumeImage> make_anisotropy_volume(
    std::shared_ptr<const TensorVoxels> voxels);

/// Of FA for a context: a faint grey veil of what has a direction at all.
[[nodiscard]] ColorTransfer anisotropy_veil();
/// Of FA for a focus: solid where fibres run.
[[nodiscard]] ColorTransfer anisotropy_body();

}  // namespace palpate
