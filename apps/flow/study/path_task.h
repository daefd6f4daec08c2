/// What the four tasks of a flow have in common: stimuli that are paths in made fields.
#pragma once

#include "apps/flow/study/flow_stimuli.h"
#include "common/study/task.h"

namespace palpate {

class FlowPathTask : public StudyTask {
 public:
  FlowPathTask(StudyTaskInfo info, PathWish wish) : info_(std::move(info)), wish_(wish) {}

  [[nodiscard]] const StudyTaskInfo& info() const override { return info_; }
  std::string prepare(std::uint64_t seed, int count, Progress& progress) override;
  [[nodiscard]] std::unique_ptr<StudyTrial> open(int stimulus) const override;
  [[nodiscard]] std::vector<DataColumn> stimulus_columns() const override;
  [[nodiscard]] std::vector<double> stimulus_row(int stimulus) const override;

 private:
  StudyTaskInfo info_;
  PathWish wish_;
  PathChoice choice_;
};

/// @name A file each
/// @{
[[nodiscard]] std::shared_ptr<StudyTask> make_advection_2d();
[[nodiscard]] std::shared_ptr<StudyTask> make_tracing_2d();
[[nodiscard]] std::shared_ptr<StudyTask> make_advection_3d();
[[nodiscard]] std::shared_ptr<StudyTask> make_tracing_3d();
/// @}

}  // namespace palpate
