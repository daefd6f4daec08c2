/// Label maps: volumes whose whole numbers name parts, drawn in the colours of the parts.
#pragma once

#include <memory>
#include <string>

#include "common/field/transfer/color_transfer.h"
#include "common/render/volume/voxels/volume_image.h"
#include "common/scene/input.h"

namespace palpate {

/// `image` with the labels and colours of its parts where `--labels` or its file has it be a label map: a NIfTI file of
/// intent NIFTI_INTENT_LABEL, a segmentation of 3D Slicer; else as it is.
/// @throws Error (usage) where it is asked to be one and its numbers are not whole; (bad input) for a table of names.
[[nodiscard]] std::shared_ptr<const VolumeImage> with_labels(std::shared_ptr<const VolumeImage> image,
                                                             const Input& input);

/// Clear where the label is 0, else of one opacity, in the colours of a few labels: where an image shows them by itself, or
/// has many, grey. @pre image.labels is not null.
[[nodiscard]] ColorTransfer label_transfer(const VolumeImage& image);

/// What is said of the colours of a label map, or of a volume that may be one though nothing says so; else nothing.
[[nodiscard]] std::string label_note(const VolumeImage& image);

}  // namespace palpate
