/// A task for experiments: place a plane through three points of a volume.
#pragma once

#include <memory>

#include "common/study/task.h"

namespace palpate {

/// Three marked points are to be touched in turn, the button pressed at each: the plane goes through where it was
/// pressed. Guided, each point pulls the hand that comes near it.
[[nodiscard]] std::shared_ptr<StudyTask> make_plane_task();

}  // namespace palpate
