/// The verbs that write images: the fitted tensors, and what tensors measure.
#pragma once

#include <vector>

#include "common/cli/explorer.h"

namespace palpate {

/// `dtmri fit DWI --out tensor.nii.gz`
[[nodiscard]] Verb fit_verb(std::vector<UsageExample> examples);
/// `dtmri measure FILE --measure fa --out fa.nii.gz`
[[nodiscard]] Verb measure_verb(std::vector<UsageExample> examples);

}  // namespace palpate
