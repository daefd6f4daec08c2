/// All stimuli of an experiment in one picture.
#pragma once

#include "common/base/progress.h"
#include "common/render/scene_view.h"
#include "common/study/task.h"

namespace palpate {

/// A row of tiles for each ten stimuli of a task, from its first picture on, the cursor at the start.
/// @pre the tasks are prepared for `stimuli` ones. @throws Error (work failed) where OpenGL is not available; Cancelled.
[[nodiscard]] Image contact_sheet(const StudyTasks& tasks, int stimuli, Progress& progress);

}  // namespace palpate
