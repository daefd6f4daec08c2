#include "apps/flow/study/path_task.h"

#include <algorithm>
#include <iterator>
#include <tuple>

#include "common/base/index.h"

namespace palpate {

std::string FlowPathTask::prepare(std::uint64_t seed, int count, Progress& progress) {
  choice_ = choose_paths(wish_, seed, count, progress);
  return info_.title + ": the " + std::to_string(count) + " best of " + std::to_string(choice_.good) +
         " good paths, from " + std::to_string(choice_.tried) + " places; of " +
         std::to_string(choice_.fields) + " of the " + std::to_string(kFields) + " fields";
}

std::unique_ptr<StudyTrial> FlowPathTask::open(int stimulus) const {
  return std::make_unique<PathTrial>(choice_.stimuli.at(as_size(stimulus)));
}

std::vector<DataColumn> FlowPathTask::stimulus_columns() const {
  std::vector<DataColumn> columns = vector_columns("start", "where the path begins", "m");
  for (const auto& [name, what, units] :
       {std::tuple{"end", "where it ends", "m"},
        std::tuple{"back", "direction of the view, towards the viewer", ""}})
    std::ranges::move(vector_columns(name, what, units), std::back_inserter(columns));
  columns.push_back(
      {"field", "which of the " + std::to_string(kFields) + " data sets the path is in, from 0", ""});
  columns.push_back({"score", "by which the best paths were chosen: less is better", ""});
  return columns;
}

std::vector<double> FlowPathTask::stimulus_row(int stimulus) const {
  const PathStimulus& s = *choice_.stimuli.at(as_size(stimulus));
  std::vector<double> row;
  for (const Vec3& v : {s.path.front(), s.path.back(), s.view[2]}) row.insert(row.end(), {v.x, v.y, v.z});
  row.push_back(choice_.field_numbers[as_size(stimulus)]);
  row.push_back(choice_.scores[as_size(stimulus)]);
  return row;
}

}  // namespace palpate
