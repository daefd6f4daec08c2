/// The numbers of a tensor beside the picture.
#pragma once

#include "common/render/tensor/tensor_view.h"

namespace palpate {

class ReadoutRows;

/// The rows of a tensor: its anisotropies, mean diffusivity and main direction.
void add_tensor_rows(const Mat3& tensor, ReadoutRows& rows);

/// The rows of a mean outer product of fibres: their direction, and the eigen gap, 0 where it is undefined
/// and 1 where all fibres agree.
void add_fibre_rows(const Mat3& fibres, ReadoutRows& rows);

/// A small window with its upper left corner at `left`, `top` [pixels]. @return its height.
float draw_tensor_readout(const TensorPick& pick, float left, float top);

}  // namespace palpate
