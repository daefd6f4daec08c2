/// A task for experiments: follow a fibre of a heart.
#pragma once

#include <memory>

#include "common/study/task.h"

namespace palpate {

/// A fibre of the built-in ventricle (field/analytic/ventricle.h) in closed form, drawn among others of its layer.
[[nodiscard]] std::shared_ptr<StudyTask> make_fibre_task();

}  // namespace palpate
