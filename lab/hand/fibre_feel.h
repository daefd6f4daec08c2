/// What a hand feels of a heart: how well its proxies keep to layers, what a step costs, and the friction of
/// fibres that leave their layer (Ikits 2006, eqs. 8.1 and 8.2 as corrected).
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "common/base/progress.h"
#include "common/trace/layer_fibre.h"
#include "lab/data/stability.h"
#include "lab/data/sweep.h"
#include "lab/hand/step_errors.h"
#include "lab/page/section.h"

namespace palpate {

/// A stroke over a heart with the chain of layer, groove and friction.
struct FibreFeel {
  std::size_t steps = 0, held = 0;
  double off_layer = 0.0;      ///< largest distance of any proxy from its layer [diagonals]
  double off_threshold = 0.0;  ///< largest difference of the drag threshold from (8.1) [mm]
  StepErrors microseconds;     ///< of a step, this thread's processor time
  double p999 = 0.0;           ///< of them, the 99.9th of a hundred [us]
};

/// Around the ventricle in the middle of its wall, with fibres that rise out of their layer by one angle.
struct FrictionRow {
  double degrees = 0.0;   ///< imbrication
  double expected = 0.0;  ///< tau_f by the corrected eq. 8.1 [mm]
  double lag = 0.0;       ///< mean distance that the last proxy stays behind [mm]
  double worst = 0.0;     ///< largest difference of that from tau_f [mm]
};

/// A slow hand from place to place in the box about the heart's wall, some seconds long. @throws Cancelled.
[[nodiscard]] FibreFeel run_fibre_feel(const std::shared_ptr<const LayeredHeart>& heart, Effort effort,
                                       Progress* progress);
/// @throws Cancelled.
[[nodiscard]] std::vector<FrictionRow> run_friction(Effort effort, Progress* progress);

[[nodiscard]] ReportSection fibre_feel_section(const std::string& subject, const FibreFeel& feel,
                                               const std::vector<FrictionRow>& friction);
/// That proxies lie on their layers and drag as (8.1) says.
[[nodiscard]] std::vector<StabilityCase> fibre_feel_cases(const FibreFeel& feel,
                                                          const std::vector<FrictionRow>& friction);

}  // namespace palpate
