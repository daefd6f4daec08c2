/// The verb `study`, which programs share: an experiment from its design to its analysis.
#pragma once

#include <functional>
#include <vector>

#include "common/cli/explorer.h"
#include "common/study/task.h"

namespace palpate {

/// @param tasks makes the program's tasks, not prepared yet.
[[nodiscard]] Verb study_verb(std::function<StudyTasks()> tasks, std::vector<UsageExample> examples);

}  // namespace palpate
