/// The diffusion weighting that a NRRD header states (the DWMRI convention of the NA-MIC project): key/value
/// pairs modality:=DWMRI, DWMRI_b-value, DWMRI_gradient_NNNN, and DWMRI_NEX_NNNN for gradients that are
/// repeated.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "common/field/tensor/gradient_table.h"

namespace palpate {

/// The value of a key, or none.
using NrrdKeys = std::function<std::optional<std::string>(const std::string& key)>;

/// The table of `volumes` volumes, or none where the header states no b-value. The b-value is that of the
/// longest gradient; a shorter one weighs by the square of its length.
/// @param ras_from_gradient the measurement frame in RAS: its columns are the axes of the gradients.
/// @param notes what was taken how.
/// @throws Error (bad input) with `file` where a gradient is missing or is no direction.
[[nodiscard]] std::optional<GradientTable> read_nrrd_gradients(const NrrdKeys& keys, std::size_t volumes,
                                                               const Mat3& ras_from_gradient,
                                                               const std::string& file,
                                                               std::vector<std::string>& notes);

}  // namespace palpate
