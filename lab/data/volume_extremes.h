/// The volume at hand put to the extremes: its picture must stay as it is, or be empty. Made ones stand in the catalogue
/// (lab/extremes).
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
