/// A task for experiments: trace a bundle of a diffusion-tensor image.
#pragma once

#include <memory>

#include "common/study/task.h"

namespace palpate {

/// Parts of the bundles of the built-in images (field/analytic/tensor_examples.h), whose middles are known in closed
/// form.
[[nodiscard]] std::shared_ptr<StudyTask> make_bundle_task();

}  // namespace palpate
