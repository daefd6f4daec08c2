/// The part of the panel about slices and glyphs, and the numbers of the voxel under the mouse.
#pragma once

#include <string>

#include "common/render/tensor/tensor_pick.h"

namespace palpate {

class ReadoutRows;

/// @param anatomical the data's axes lead to the right, the front and up of a patient.
void draw_tensor_panel(TensorView& view, bool anatomical);

/// The image below the slices. @param file its path. @return whether it is to be removed.
[[nodiscard]] bool draw_underlay_panel(TensorView& view, const std::string& file);

/// The rows of a tensor: its anisotropies, mean diffusivity and main direction.
void add_tensor_rows(const Mat3& tensor, ReadoutRows& rows);

/// The rows of a mean outer product of fibres: their direction, and the eigen gap, 0 where it is undefined
/// and 1 where all fibres agree.
void add_fibre_rows(const Mat3& fibres, ReadoutRows& rows);

/// A small window with its upper left corner at `left`, `top` [pixels]. @return its height.
float draw_tensor_readout(const TensorPick& pick, float left, float top);

}  // namespace palpate
