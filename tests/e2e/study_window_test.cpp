// A whole session of an experiment, all four tasks, in the window, driven by mouse and keyboard under a virtual display:
// killed in the middle of a trial, gone on with, and played back; and what is said where there is no force.
#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/e2e/study_session.h"
#include "tests/support/project_folders.h"
#include "tests/support/temp_folder.h"

namespace palpate::test {
namespace {

TEST(StudyWindow, ASessionThatIsKilledGoesOnWithoutLoss) {
  if (std::getenv("DISPLAY") == nullptr) GTEST_SKIP() << "no display: run under xvfb-run";
  ASSERT_TRUE(MouseAndKeys::is_there()) << "xdotool is missing: scripts/packages.sh names it";
  TempFolder temporary;
  const fs::path path = temporary.path("s");
  const StudyPlan plan = session_plan();
  const StudyParticipant who{"P01", 0, false, {}};
  StudyFolder folder = StudyFolder::make(path, plan, {}, false);
  const StudyTasks tasks = prepared_tasks(plan);
  ASSERT_EQ(folder.left_for(who).size(), 8U);
  // PALPATE_WRITE_PAGES makes the pictures of docs/guide/study.md.
  const fs::path pictures =
      std::getenv("PALPATE_WRITE_PAGES") != nullptr ? source_folder() / "docs" / "guide" : fs::path();

  const fs::path told = temporary.path("told.txt"), told_later = temporary.path("later.txt");
  const pid_t first =
      start_session(path, {.tasks = tasks, .hands = Hands(), .told = told, .pictures = pictures});
  const fs::path at_work = path / "sub-P01" / "trial_at_work.txt";
  SessionGuard first_guard(first);
  ASSERT_GT(first, 0);
  // What is recorded is handed on each second: a trial that has begun is in the file then.
  std::optional<int> status;
  const auto begun = [&] {
    return fs::exists(at_work) && read_file(at_work).find(kBeginEvent) != std::string::npos;
  };
  ASSERT_TRUE(wait_until([&] {
    status = first_guard.ended();
    return status || (folder.trials().size() >= 3 && begun());
  }));
  ASSERT_FALSE(status) << "it is to be killed, and not to end";
  ASSERT_EQ(::kill(first, SIGKILL), 0);
  status = outcome_of(first_guard);
  ASSERT_TRUE(status);
  EXPECT_TRUE(WIFSIGNALED(*status));
  const std::vector<TrialRecord> before = folder.trials();
  EXPECT_GE(before.size(), 3U) << "all that were done are there";
  EXPECT_EQ(folder.participants().size(), 1U) << "the window has entered who began";

  // The second part begins under a window that is slow: nothing depends on how many pictures there are.
  constexpr double kSlow = 0.12;  // [s]
  SessionGuard second(
      start_session(path, {.tasks = tasks, .hands = Hands(kSlow), .told = told_later, .pictures = pictures}));
  status = outcome_of(second);
  ASSERT_TRUE(status && WIFEXITED(*status));
  EXPECT_EQ(WEXITSTATUS(*status), 0);
  // The mouse leads at the depth of the start as that is shown: nothing draws the hand off it, in no task.
  std::size_t starts = 0;
  for (const fs::path& file : {told, told_later}) {
    std::ifstream lines(file);
    for (std::string line; std::getline(lines, line);) {
      if (!line.starts_with(kStartDepth)) continue;
      ++starts;
      EXPECT_NEAR(std::stod(line.substr(kStartDepth.size())), 0.0, 1e-6);
    }
  }
  EXPECT_GE(starts, 8U) << "each trial has one";
  EXPECT_TRUE(folder.left_for(who).empty());
  EXPECT_FALSE(fs::exists(at_work));
  EXPECT_EQ(folder.answers("P01").at("harder_3d"), "4");
  const std::vector<TrialRecord> trials = folder.trials();
  for (const TrialRecord& was : before) {
    const auto now = std::ranges::find_if(
        trials, [&](const TrialRecord& r) { return r.task == was.task && r.run == was.run; });
    ASSERT_NE(now, trials.end());
    EXPECT_EQ(now->outcome.error, was.outcome.error) << "what was done before stays";
  }

  // What was lived is what is played back: the servo's thread and its clock change nothing.
  std::map<std::string, int> good;
  for (const TrialRecord& record : trials) {
    EXPECT_FALSE(record.simulated);
    EXPECT_GT(record.outcome.seconds, 0.5);
    const auto task =
        std::ranges::find_if(tasks, [&](const auto& t) { return t->info().name == record.task; });
    const std::unique_ptr<StudyTrial> trial = (*task)->open(record.stimulus);
    const TrialReplay again = replay_trial(*trial, folder.recording("P01", record.task, record.run));
    EXPECT_TRUE(again.identical) << again.verdict;
    EXPECT_EQ(again.outcome.error, record.outcome.error) << record.task << " " << record.run;
    EXPECT_EQ(again.outcome.seconds, record.outcome.seconds);
    // A servo that a busy machine lets stand still cuts the force, and one that stands still for seconds lets the time
    // run out. All others end at their goal, and each task has one.
    if (record.outcome.flaws.any() || record.outcome.timed_out) continue;
    ++good[record.task];
    EXPECT_TRUE(record.outcome.reached) << record.task << " " << record.run;
    constexpr double kNear = 25.0;  // [mm]
    EXPECT_LT(record.outcome.error, kNear)
        << record.task << " " << record.run << ", " << condition_name(record.guided) << ", "
        << record.outcome.seconds << " s";
  }
  EXPECT_EQ(good.size(), 4U) << "each task was done";
}

TEST(StudyWindow, SaysThatThereIsNoForceAndRepeatsTheTrial) {
  if (std::getenv("DISPLAY") == nullptr) GTEST_SKIP() << "no display: run under xvfb-run";
  ASSERT_TRUE(MouseAndKeys::is_there()) << "xdotool is missing: scripts/packages.sh names it";
  TempFolder temporary;
  StudyPlan plan = session_plan();
  plan.tasks = {"tracing2d"};
  plan.design.tasks = 1;
  const StudyFolder folder = StudyFolder::make(temporary.path("s"), plan, {}, false);
  const StudyTasks tasks = prepared_tasks(plan);
  SessionGuard session(start_session(
      folder.path(), {.tasks = tasks, .hands = Hands(0.0, true), .told = temporary.path("told.txt")}));
  const std::optional<int> status = outcome_of(session);
  ASSERT_TRUE(status && WIFEXITED(*status));
  ASSERT_EQ(WEXITSTATUS(*status), 0);
  const std::string told = read_file(temporary.path("told.txt"));
  for (const std::string words :
       {"screen: The force is switched off. Hold the hand still, then press the space bar",
        "P01: before tracing2d/1: no force (switched_off)", "screen: The force is off. Press the space bar",
        "P01: tracing2d/1: ", "with the force switched off; it is repeated at the end of its block"})
    EXPECT_NE(told.find(words), std::string::npos) << words << "\n" << told;

  std::map<int, TrialRecord> trials;
  for (const TrialRecord& record : folder.trials()) trials[record.run] = record;
  ASSERT_GE(trials.size(), 3U);
  EXPECT_GT(trials.at(1).outcome.flaws.off, 0U);
  EXPECT_EQ(trials.at(3).attempt, 1) << "two trials are planned: the third is the first one again";
  EXPECT_EQ(trials.at(3).stimulus, trials.at(1).stimulus);
  EXPECT_EQ(trials.at(3).guided, trials.at(1).guided);
  EXPECT_EQ(trials.at(3).outcome.flaws.off, 0U) << "the force came back";
  const auto written = [&](int run) {
    return fs::last_write_time(folder.path() / "sub-P01" / "beh" /
                               ("sub-P01_task-tracing2d_run-0" + std::to_string(run) + "_beh.json"));
  };
  EXPECT_GT(written(3), written(2)) << "at the end of the block";
}

}  // namespace
}  // namespace palpate::test
