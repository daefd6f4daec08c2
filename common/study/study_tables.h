/// The tables of an experiment's folder, and their data dictionaries: text of what files hold.
#pragma once

#include <string>
#include <vector>

#include "common/base/json.h"
#include "common/study/design.h"
#include "common/study/study_participant.h"
#include "common/study/task.h"

namespace palpate {

/// As all JSON files of the folder are written.
[[nodiscard]] std::string pretty(const Json& json);
/// Letters and digits alone, 32 at most: what becomes part of a file's name.
[[nodiscard]] bool is_plain(const std::string& word);

/// task-NAME_beh.json: of a task, and of what came of its trials.
[[nodiscard]] std::string task_dictionary(const StudyTaskInfo& info);

[[nodiscard]] std::string stimulus_table(const StudyTask& task, const DesignRequest& design);
[[nodiscard]] std::string stimulus_dictionary(const StudyTask& task);

/// Every tenth step: 100 a second at a servo of 1 kHz.
[[nodiscard]] std::string motion_table(const std::vector<HandStep>& steps);
[[nodiscard]] std::string motion_dictionary();

/// @param tasks names, in the order that the design counts them.
[[nodiscard]] std::string design_table(const std::vector<PlannedTrial>& design,
                                       const std::vector<std::string>& tasks);
[[nodiscard]] const std::vector<DataColumn>& design_columns();

[[nodiscard]] std::string participants_table(const std::vector<StudyParticipant>& people);
[[nodiscard]] std::vector<DataColumn> participant_columns();
/// What a table says. @param most participants of the design. @throws Error (bad input) that names `file`.
[[nodiscard]] std::vector<StudyParticipant> participants_of(const std::string& file, const std::string& table,
                                                            int most);

}  // namespace palpate
