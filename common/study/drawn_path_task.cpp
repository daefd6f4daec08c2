#include "common/study/drawn_path_task.h"

#include <utility>

#include "common/base/error.h"
#include "common/base/index.h"

namespace palpate {

std::string DrawnPathTask::prepare(std::uint64_t seed, int count, Progress& progress) {
  RandomStream random({seed, stream_});
  stimuli_.clear();
  std::size_t tried = 0;
  constexpr std::size_t kMostTries = 10'000;
  for (; stimuli_.size() < as_size(count) && tried < kMostTries; ++tried) {
    progress.check();
    if (auto stimulus = draw(random)) stimuli_.push_back(std::move(stimulus));
  }
  if (stimuli_.size() < as_size(count))
    throw work_error("only " + std::to_string(stimuli_.size()) + " of " + std::to_string(count) + " " +
                     of_what_ + " are long enough; try another --seed, or fewer trials");
  return info_.title + ": " + std::to_string(count) + " " + of_what_ + ", from " + std::to_string(tried) +
         " places";
}

std::unique_ptr<StudyTrial> DrawnPathTask::open(int stimulus) const {
  return std::make_unique<PathTrial>(stimuli_.at(as_size(stimulus)));
}

std::vector<DataColumn> DrawnPathTask::stimulus_columns() const {
  std::vector<DataColumn> columns = vector_columns("start", "where the path begins", "m");
  for (DataColumn& column : vector_columns("end", "where it ends", "m")) columns.push_back(std::move(column));
  return columns;
}

std::vector<double> DrawnPathTask::stimulus_row(int stimulus) const {
  const std::vector<Vec3>& path = stimuli_.at(as_size(stimulus))->path;
  return {path.front().x, path.front().y, path.front().z, path.back().x, path.back().y, path.back().z};
}

std::vector<Vec3> evenly_spaced(const std::function<Vec3(double u)>& position, double u, double last,
                                double step, double length, int pieces) {
  const double spacing = length / pieces;
  Vec3 from = position(u);
  std::vector<Vec3> path{from};
  double left = spacing;
  for (; path.size() <= as_size(pieces); u += step) {
    if (u + step > last) return {};
    const Vec3 next = position(u + step);
    double piece = glm::distance(from, next);
    while (piece >= left && path.size() <= as_size(pieces)) {
      from += left / piece * (next - from);
      path.push_back(from);
      piece = glm::distance(from, next);
      left = spacing;
    }
    left -= piece;
    from = next;
  }
  return path;
}

}  // namespace palpate
