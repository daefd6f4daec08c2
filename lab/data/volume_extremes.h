/// Extreme volumes: what their pictures are by closed form or by symmetry, and how far off they are drawn.
///
/// Made ones are seen along an axis through a block of one value, whose opacity along a way d is 1 - (1 - alpha)^(d / l) (Ikits
/// 2006, eq. 2.1; color_transfer.h). Others alter the data at hand so that the picture must stay as it is, or be empty.
#pragma once

#include <vector>

#include "common/base/progress.h"
#include "common/base/work_precision.h"
#include "common/render/volume/volume_view.h"

namespace palpate {

/// @param view the data at hand; its own lenses and cuts are left out. @pre view.image is not null.
/// @throws Error (work failed) without OpenGL; Cancelled.
[[nodiscard]] std::vector<StabilityCase> run_volume_extremes(const VolumeView& view, Progress* progress);

}  // namespace palpate
