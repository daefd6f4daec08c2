/// Tasks whose stimuli are paths drawn at random: each says what one draw gives.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "common/study/path_trial.h"
#include "common/study/random_stream.h"
#include "common/study/task.h"

namespace palpate {

class DrawnPathTask : public StudyTask {
 public:
  /// @param stream which of the seed's random sequences is this task's.
  /// @param of_what what the paths are, for sentences: "fibres".
  DrawnPathTask(StudyTaskInfo info, std::uint64_t stream, std::string of_what)
      : info_(std::move(info)), stream_(stream), of_what_(std::move(of_what)) {}

  [[nodiscard]] const StudyTaskInfo& info() const override { return info_; }
  /// @throws Error (work failed) where ten thousand draws give too few.
  std::string prepare(std::uint64_t seed, int count, Progress& progress) override;
  [[nodiscard]] std::unique_ptr<StudyTrial> open(int stimulus) const override;
  [[nodiscard]] std::vector<DataColumn> stimulus_columns() const override;
  [[nodiscard]] std::vector<double> stimulus_row(int stimulus) const override;

 private:
  /// One stimulus, or null where the path would leave the data before its end.
  [[nodiscard]] virtual std::shared_ptr<const PathStimulus> draw(RandomStream& random) const = 0;

  StudyTaskInfo info_;
  std::uint64_t stream_;
  std::string of_what_;
  std::vector<std::shared_ptr<const PathStimulus>> stimuli_;
};

/// `pieces` + 1 points of a curve from `u` on, evenly spaced over `length` [m]; none where `last` comes before that.
/// @param position of the curve at a parameter [m]. @param step of the parameter in which the curve is followed.
[[nodiscard]] std::vector<Vec3> evenly_spaced(const std::function<Vec3(double u)>& position, double u,
                                              double last, double step, double length, int pieces);

}  // namespace palpate
