#include "apps/flow/study/path_task.h"

#include "common/base/index.h"

namespace palpate {

std::string FlowPathTask::prepare(std::uint64_t seed, int count, Progress& progress) {
  choice_ = choose_paths(wish_, seed, count, progress);
  return info_.title + ": the " + std::to_string(count) + " best of " + std::to_string(choice_.good) +
         " good paths, from " + std::to_string(choice_.tried) + " places";
}

std::unique_ptr<StudyTrial> FlowPathTask::open(int stimulus) const {
  return std::make_unique<PathTrial>(choice_.stimuli.at(as_size(stimulus)));
}

std::vector<std::string> FlowPathTask::stimulus_columns() const {
  return {"start_x", "start_y", "start_z", "end_x", "end_y", "end_z", "back_x", "back_y", "back_z", "score"};
}

std::vector<double> FlowPathTask::stimulus_row(int stimulus) const {
  const PathStimulus& s = *choice_.stimuli.at(as_size(stimulus));
  std::vector<double> row;
  for (const Vec3& v : {s.path.front(), s.path.back(), s.view[2]}) row.insert(row.end(), {v.x, v.y, v.z});
  row.push_back(choice_.scores[as_size(stimulus)]);
  return row;
}

}  // namespace palpate
