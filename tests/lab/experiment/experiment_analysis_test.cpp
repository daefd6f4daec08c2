// What is left out of an experiment, and what is made of the rest, on trials whose numbers are given.
#include "lab/experiment/experiment_analysis.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/temp_folder.h"

namespace palpate::test {
namespace {

/// A task that has a description alone.
class NamedTask final : public StudyTask {
 public:
  explicit NamedTask(StudyTaskInfo info) : info_(std::move(info)) {}
  [[nodiscard]] const StudyTaskInfo& info() const override { return info_; }
  std::string prepare(std::uint64_t /*seed*/, int /*count*/, Progress& /*progress*/) override { return {}; }
  [[nodiscard]] std::unique_ptr<StudyTrial> open(int /*stimulus*/) const override { return nullptr; }
  [[nodiscard]] std::vector<DataColumn> stimulus_columns() const override { return {}; }
  [[nodiscard]] std::vector<double> stimulus_row(int /*stimulus*/) const override { return {}; }

 private:
  StudyTaskInfo info_;
};

TEST(ExperimentAnalysis, LeavesOutByTheRuleAndComparesTheRest) {
  TempFolder temporary;
  StudyPlan plan{.program = "made", .version = "1", .tasks = {"flat", "deep"}};
  plan.design = {.participants = 4, .tasks = 2, .practice = 1, .recorded = 4, .seed = 1};
  const StudyTasks tasks{std::make_shared<NamedTask>(StudyTaskInfo{.name = "flat",
                                                                   .title = "Flat",
                                                                   .pair = "deep",
                                                                   .flat = true,
                                                                   .cutoff_time = 10.0,
                                                                   .cutoff_error = 30.0}),
                         std::make_shared<NamedTask>(StudyTaskInfo{.name = "deep",
                                                                   .title = "Deep",
                                                                   .pair = "flat",
                                                                   .flat = false,
                                                                   .cutoff_time = 15.0,
                                                                   .cutoff_error = 100.0})};
  const StudyFolder folder = StudyFolder::make(temporary.path("s"), plan, tasks, false);
  // Participant i errs by 10 + i mm in the plane and 20 + 2 i in space, 4 and 5 + i/10 less where guided.
  std::vector<TrialRecord> trials;
  for (const PlannedTrial& t : folder.design()) {
    TrialRecord r{.participant = StudyFolder::code_of(t.participant),
                  .task = plan.tasks[static_cast<std::size_t>(t.task)],
                  .run = t.trial + 1,
                  .stimulus = t.stimulus,
                  .practice = t.practice,
                  .guided = t.guided};
    const double i = t.participant;
    const double help = t.guided ? (t.task == 0 ? 4.0 + 0.1 * i : 5.0 + 0.1 * i) : 0.0;
    r.outcome.error = (t.task == 0 ? 10.0 + i : 20.0 + 2.0 * i) - help;
    r.outcome.seconds = t.practice ? 99.0 : 3.0;
    trials.push_back(r);
  }
  ExperimentAnalysis found = analyse_experiment(folder, trials);
  ASSERT_EQ(found.tasks.size(), 2U);
  const TaskAnalysis& flat = found.tasks[0];
  EXPECT_EQ(flat.trials, 16U) << "practice does not count";
  EXPECT_EQ(flat.too_far + flat.too_slow, 0U);
  // Differences 4, 4.1, 4.2, 4.3: mean 4.15, deviation sqrt(0.05 / 3), t = 4.15 / (deviation / 2).
  const PairedTest& test = flat.of(Measure::kError).of_means;
  EXPECT_NEAR(test.mean, 4.15, 1e-12);
  EXPECT_NEAR(test.t, 4.15 / (std::sqrt(0.05 / 3.0) / 2.0), 1e-9);
  EXPECT_EQ(test.freedom, 3.0);
  EXPECT_NEAR(flat.of(Measure::kError).permutation.effect, -4.15, 1e-9) << "of guidance";
  ASSERT_EQ(found.dimensions.size(), 2U);
  // In space less in the plane, unguided: 10 + i.
  EXPECT_NEAR(found.dimensions[0].errors.mean, 11.5, 1e-12);

  // One trial beyond the error, one beyond the time, one beyond both: counted once, for the error.
  int changed = 0;
  for (TrialRecord& r : trials) {
    if (r.task != "flat" || r.practice || changed == 3) continue;
    if (changed != 1) r.outcome.error = 31.0;
    if (changed != 0) r.outcome.seconds = 10.5;
    ++changed;
  }
  found = analyse_experiment(folder, trials);
  EXPECT_EQ(found.tasks[0].too_far, 2U);
  EXPECT_EQ(found.tasks[0].too_slow, 1U);
  EXPECT_EQ(found.tasks[0].participants.size(), 3U) << "one has too few trials left";
  EXPECT_EQ(found.tasks[0].lacking, std::vector<std::string>{"P01"});
  EXPECT_EQ(found.tasks[1].participants.size(), 4U);

  // Steps without force, in a trial that was left out for its error: it is counted for the force, once.
  for (TrialRecord& r : trials) {
    if (r.task == "flat" && r.outcome.error == 31.0 && found.tasks[0].flawed == 0) r.outcome.flaws.cut = 1;
  }
  found = analyse_experiment(folder, trials);
  EXPECT_EQ(found.tasks[0].flawed, 2U);
  EXPECT_EQ(found.tasks[0].too_far, 0U);
  EXPECT_EQ(found.tasks[1].unreached, 16U) << "none of these reached a goal, and that is told";

  // By condition: what counts and what is left out for error or time are all that is not flawed.
  EXPECT_EQ(found.tasks[0].outliers[0] + found.tasks[0].outliers[1],
            found.tasks[0].too_far + found.tasks[0].too_slow);
  EXPECT_EQ(found.tasks[1].kept[0], 8U);
  EXPECT_EQ(found.tasks[1].kept[1], 8U);
  // A repeat of a trial with flaws counts in its place.
  TrialRecord again =
      *std::ranges::find_if(trials, [](const TrialRecord& r) { return r.outcome.flaws.any(); });
  again.outcome.flaws = {};
  again.outcome.error = 5.0;
  again.outcome.seconds = 3.0;
  again.attempt = 1;
  trials.push_back(again);
  const std::size_t kept = found.tasks[0].kept[0] + found.tasks[0].kept[1];
  found = analyse_experiment(folder, trials);
  EXPECT_EQ(found.tasks[0].repeats, 1U);
  EXPECT_EQ(found.tasks[0].flawed, 2U);
  EXPECT_EQ(found.tasks[0].kept[0] + found.tasks[0].kept[1], kept + 1);
  trials.pop_back();

  // A program beside people is not analysed.
  for (TrialRecord& r : trials) r.simulated = r.participant == "P04";
  found = analyse_experiment(folder, trials);
  EXPECT_FALSE(found.simulated);
  EXPECT_EQ(found.set_aside, 1U);
  EXPECT_EQ(found.participants, 3U);
  EXPECT_EQ(found.tasks[1].participants.size(), 3U);
  for (TrialRecord& r : trials) r.simulated = true;
  found = analyse_experiment(folder, trials);
  EXPECT_TRUE(found.simulated);
  EXPECT_EQ(found.set_aside, 0U);
}

}  // namespace
}  // namespace palpate::test
