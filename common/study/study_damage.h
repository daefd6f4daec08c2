/// Whether the files beside what came of a trial are whole: the analysis can do without them, but nobody can play the
/// trial back, or look at its motion.
#pragma once

#include <string>
#include <vector>

#include "common/base/progress.h"
#include "common/study/study_folder.h"

namespace palpate {

struct DamagedFile {
  std::string participant, task;
  int run = 1;
  std::string file;  ///< in the folder of the experiment
  std::string why;   ///< "it is not there", "it is damaged or cut off"
};

/// Unpacks the recording and the motion of each trial. @return those that are not whole, in the order of `trials`.
/// @param threads 0: as many as there are cores. @throws Cancelled.
[[nodiscard]] std::vector<DamagedFile> damaged_files(const StudyFolder& folder,
                                                     const std::vector<TrialRecord>& trials,
                                                     Progress& progress, int threads);

}  // namespace palpate
