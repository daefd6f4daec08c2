// A trial of a simulated participant, its recording and its replay, on a field in closed form.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <memory>
#include <numbers>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/base/index.h"
#include "common/base/parallel.h"
#include "common/study/packed_text.h"
#include "common/study/path_trial.h"
#include "common/study/scattered_field.h"
#include "common/study/statistics.h"
#include "common/study/study_folder.h"
#include "common/study/trial_run.h"
#include "tests/support/temp_folder.h"

namespace palpate::test {
namespace {

constexpr double kRadius = 0.08, kLength = 0.06;

/// Rotation about (0.125, 0.125): streamlines are circles.
std::shared_ptr<const PathStimulus> circle_stimulus(PathGoal goal, bool shown) {
  static const auto field = [] {
    const Box box{{0.0, 0.0, -0.02}, {0.25, 0.25, 0.02}};
    std::vector<Vec3> values = grid_places({9, 9, 2}, box);
    for (Vec3& x : values) x = {0.125 - x.y, x.x - 0.125, 0.0};
    return grid_field({9, 9, 2}, box, values);
  }();
  auto stimulus = std::make_shared<PathStimulus>();
  for (int i = 0; i <= 100; ++i) {
    const double angle = kLength / kRadius * i / 100.0;
    stimulus->path.emplace_back(0.125 + kRadius * std::cos(angle), 0.125 + kRadius * std::sin(angle), 0.0);
  }
  stimulus->goal = goal;
  stimulus->shown = shown;
  stimulus->flat = true;
  stimulus->bounds = {Vec3{0.0}, {0.25, 0.25, 0.0}};
  stimulus->field = field;
  return stimulus;
}

const StudyTaskInfo kInfo{.name = "made", .title = "Made", .flat = true, .cutoff_time = 10.0};

const RecordingHeader kHeader;

TrialRun run_of(StudyTrial& trial, bool guided, double guidance, std::uint64_t number) {
  return simulate_trial(trial, kInfo, {"made", 0, guided, guidance}, draw_traits(1, static_cast<int>(number)),
                        RandomStream({5, number}), &kHeader);
}

HandStep at(const Vec3& x) {
  HandStep step;
  step.present = true;
  step.probe = x;
  return step;
}

TEST(PathTrial, MeasuresAdvectionWhereTheCircleIsMet) {
  PathTrial trial(circle_stimulus(PathGoal::kCircle, false));
  const Vec3 start = trial.start(), end = circle_stimulus(PathGoal::kCircle, false)->path.back();
  const double radius = glm::distance(start, end);
  trial.begin();
  trial.follow(at(start));
  EXPECT_FALSE(trial.reached());
  // Straight to the right, beyond the circle and on: it is met at `radius`, to rounding.
  trial.follow(at(start + Vec3{0.9 * radius, 0.0, 0.3}));
  trial.follow(at(start + Vec3{1.3 * radius, 0.0, 0.3}));
  trial.follow(at(start + Vec3{5.0 * radius, 0.0, 0.0}));
  EXPECT_TRUE(trial.reached());
  EXPECT_NEAR(trial.error(), 1000.0 * glm::distance(start + Vec3{radius, 0.0, 0.0}, end), 1e-9);
  trial.begin();
  trial.follow(at(start));
  EXPECT_FALSE(trial.reached()) << "it begins anew";
}

TEST(PathTrial, MeasuresTracingByTheMeanDistance) {
  PathTrial trial(circle_stimulus(PathGoal::kEnd, true));
  trial.begin();
  for (int i = 10; i <= 50; ++i) {
    const double angle = kLength / kRadius * i / 100.0;
    trial.follow(at({0.125 + 0.083 * std::cos(angle), 0.125 + 0.083 * std::sin(angle), 0.5}));
  }
  EXPECT_NEAR(trial.error(), 3.0, 1e-3) << "depth does not count in the plane";
  EXPECT_FALSE(trial.reached());
}

TEST(PathTrial, MeetsAGroundPlaneOnTheWayDown) {
  auto stimulus = std::make_shared<PathStimulus>(*circle_stimulus(PathGoal::kPlane, false));
  stimulus->flat = false;
  stimulus->path = {{0.1, 0.1, 0.2}, {0.12, 0.1, 0.15}, {0.16, 0.1, 0.1}};
  PathTrial trial(stimulus);
  trial.begin();
  trial.follow(at({0.10, 0.10, 0.20}));
  trial.follow(at({0.15, 0.10, 0.11}));
  trial.follow(at({0.16, 0.13, 0.09}));
  EXPECT_TRUE(trial.reached());
  EXPECT_NEAR(trial.error(), std::hypot(5.0, 15.0), 1e-9);
}

/// However the hand lies when the trial begins, it is the line through the start that holds it.
TEST(PathTrial, GuidesAlongTheLineThroughTheStart) {
  const PathTrial trial(circle_stimulus(PathGoal::kCircle, false));
  const std::unique_ptr<ProxyChain> chain = trial.chain(true, 1.0);
  const ChainStep step = chain->step(trial.start() + Vec3{0.006, 0.002, 0.004});
  EXPECT_NEAR(glm::distance(step.proxies[0], Vec3{0.125, 0.125, 0.0}), kRadius, 1e-4);
  EXPECT_GT(glm::length(step.force), 1.0);
  EXPECT_EQ(trial.chain(true, 0.0)->step(trial.start() + Vec3{0.006, 0.0, 0.0}).force, Vec3{0.0});
}

TEST(SimulatedTrial, IsPlayedBackToTheLastBit) {
  for (const bool guided : {false, true}) {
    PathTrial trial(circle_stimulus(PathGoal::kEnd, true));
    const TrialRun run = run_of(trial, guided, 1.0, 3);
    EXPECT_FALSE(run.outcome.timed_out);
    EXPECT_GT(run.outcome.seconds, 0.5);
    TempFolder folder;
    folder.write("run.txt.gz", packed(run.recording));
    const TrialReplay again = replay_trial(trial, read_packed_recording(folder.path("run.txt.gz").string()));
    EXPECT_TRUE(again.identical) << again.verdict;
    EXPECT_EQ(again.outcome.error, run.outcome.error);
    EXPECT_EQ(again.outcome.seconds, run.outcome.seconds);
    EXPECT_EQ(again.outcome.begin, run.outcome.begin);
  }
}

TEST(SimulatedTrial, AnotherHandIsToldFromIt) {
  PathTrial trial(circle_stimulus(PathGoal::kEnd, true));
  TrialRun run = run_of(trial, true, 1.0, 3);
  const std::string text = "ANISO 1\n", softer = "ANISO 0.5\n";
  run.recording.replace(run.recording.find(text), text.size(), softer);
  TempFolder folder;
  folder.write("run.txt.gz", packed(run.recording));
  EXPECT_FALSE(replay_trial(trial, read_packed_recording(folder.path("run.txt.gz").string())).identical);
}

/// Position errors of people, one trial each. @param trials names them: other ones have other noises.
std::vector<double> errors_of(int people, std::uint64_t trials, bool guided, double guidance) {
  PathTrial trial(circle_stimulus(PathGoal::kCircle, false));
  std::vector<double> out;
  for (int i = 0; i < people; ++i) {
    const RandomStream random({9, trials, static_cast<std::uint64_t>(i), guided ? 1U : 0U});
    const ChainWords words{"made", 0, guided, guidance};
    out.push_back(simulate_trial(trial, kInfo, words, draw_traits(trials, i), random, nullptr).outcome.error);
  }
  return out;
}

TEST(SimulatedTrial, GuidanceHelps) {
  const PairedTest helps = paired_test(errors_of(12, 1, false, 1.0), errors_of(12, 1, true, 1.0));
  EXPECT_GT(helps.mean, 0.0);
  EXPECT_LT(helps.p, 0.01);
}

/// Without force both conditions are one, and p is uniform. PALPATE_STUDY_SEEDS=200 asks that of 200 studies
/// (docs/guide/study.md has what came of it); by default a few are looked at.
TEST(SimulatedTrial, WithoutForceThereIsNoEffect) {
  const char* const asked = std::getenv("PALPATE_STUDY_SEEDS");
  const int seeds = asked != nullptr ? std::max(1, std::atoi(asked)) : 4;
  const int people = asked != nullptr ? 8 : 5;
  std::vector<double> p(as_size(seeds));
  parallel_for(p.size(), 0, [&](std::size_t first, std::size_t last) {
    for (std::size_t s = first; s < last; ++s)
      p[s] = paired_test(errors_of(people, 100 + s, false, 0.0), errors_of(people, 100 + s, true, 0.0)).p;
  });
  for (const double one : p) EXPECT_GT(one, 1e-4);
  const UniformityTest test = uniformity_test(p);
  RecordProperty("distance", std::to_string(test.distance));
  if (asked != nullptr) {
    const auto below = std::ranges::count_if(p, [](double x) { return x < 0.05; });
    std::cout << seeds << " studies: D = " << test.distance << ", p = " << test.p << ", " << below
              << " below 0.05\n";
  }
  EXPECT_GT(test.p, 0.01);
}

TEST(ChainWords, ComeBackFromText) {
  const ChainWords words = chain_words(chain_text({"tracing3d", 12, true, 0.1}));
  EXPECT_EQ(words.task, "tracing3d");
  EXPECT_EQ(words.stimulus, 12);
  EXPECT_TRUE(words.guided);
  EXPECT_EQ(words.guidance, 0.1);
  for (const char* bad : {"", "start", "trial a b ISO 1", "trial a -1 ISO 1", "trial a 1 ISO nan"})
    EXPECT_THROW((void)chain_words(bad), Error) << bad;
}

StudyPlan small_plan() {
  StudyPlan plan{.program = "made", .version = "1", .tasks = {"made"}};
  plan.design = {.participants = 2, .tasks = 1, .practice = 1, .recorded = 2, .seed = 4};
  return plan;
}

TEST(StudyFolder, KeepsTrialsAndKnowsWhichAreLeft) {
  TempFolder temporary;
  StudyFolder made = StudyFolder::make(temporary.path("s"), small_plan(), {}, false);
  const StudyParticipant who{"P01", 0, true, {{"speed", 0.1}}};
  made.enter(who);
  ASSERT_EQ(made.left_for(who).size(), 3U);
  const PlannedTrial first = made.left_for(who).front();
  PathTrial trial(circle_stimulus(PathGoal::kEnd, true));
  const TrialRun run = run_of(trial, first.guided, 1.0, 1);
  made.write({"P01", "made", first.trial + 1, first.stimulus, first.practice, first.guided, true, "simulated",
              run.outcome},
             run.recording, run.steps);
  const StudyFolder again(temporary.path("s"));
  EXPECT_EQ(again.left_for(who).size(), 2U);
  EXPECT_EQ(again.plan().design.seed, 4U);
  EXPECT_EQ(again.participants().at(0).traits.at(0).second, 0.1);
  const std::vector<TrialRecord> trials = again.trials();
  ASSERT_EQ(trials.size(), 1U);
  EXPECT_EQ(trials[0].outcome.error, run.outcome.error) << "all digits";
  EXPECT_TRUE(trials[0].simulated);
  EXPECT_EQ(replay_trial(trial, again.recording("P01", "made", 1)).outcome.error, run.outcome.error);
  for (const auto& entry : std::filesystem::recursive_directory_iterator(temporary.path("s")))
    EXPECT_NE(entry.path().extension(), ".part") << entry.path();
}

TEST(StudyFolder, ATrialWithoutItsLastFileIsDoneAgain) {
  TempFolder temporary;
  StudyFolder made = StudyFolder::make(temporary.path("s"), small_plan(), {}, false);
  const StudyParticipant who{"P01", 0, false, {}};
  made.enter(who);
  temporary.write("s/sub-P01/beh/sub-P01_task-made_run-01_beh.json.part", "{\"participant\":");
  temporary.write("s/sub-P01/beh/sub-P01_task-made_run-01_motion.tsv.gz", "cut");
  EXPECT_EQ(made.left_for(who).size(), 3U);
  temporary.write("s/sub-P01/beh/sub-P01_task-made_run-01_beh.json", "{\"participant\":");
  EXPECT_THROW((void)made.trials(), Error) << "one that was damaged is named, not passed over";
}

TEST(StudyFolder, RefusesAPlanThatWouldNotFitIntoMemory) {
  TempFolder temporary;
  (void)StudyFolder::make(temporary.path("s"), small_plan(), {}, false);
  const std::string plan = read_file(temporary.path("s/study.json"));
  for (const auto& [from, to] :
       {std::pair{"\"participants\": 2", "\"participants\": 2000000000"},
        std::pair{"\"recorded_trials\": 2", "\"recorded_trials\": 3"},
        std::pair{"\"made\"\n", "\"../../etc\"\n"}, std::pair{"\"seed\": 4", "\"seed\": \"four\""}}) {
    std::string other = plan;
    ASSERT_NE(other.find(from), std::string::npos) << plan;
    other.replace(other.find(from), std::string(from).size(), to);
    temporary.write("s/study.json", other);
    EXPECT_THROW(StudyFolder{temporary.path("s")}, Error) << to;
  }
}

TEST(StudyFolder, RefusesToReplaceAndTakesNoNames) {
  TempFolder temporary;
  StudyFolder made = StudyFolder::make(temporary.path("s"), small_plan(), {}, false);
  EXPECT_THROW((void)StudyFolder::make(temporary.path("s"), small_plan(), {}, false), Error);
  EXPECT_NO_THROW((void)StudyFolder::make(temporary.path("s"), small_plan(), {}, true)) << "nobody has begun";
  EXPECT_THROW(made.enter({"../x", 0, false, {}}), Error);
  EXPECT_THROW(made.enter({"Jane Doe", 0, false, {}}), Error);
  made.enter({"P01", 0, false, {}});
  EXPECT_THROW(made.enter({"P02", 0, false, {}}), Error) << "the place is taken";
  EXPECT_THROW((void)StudyFolder::make(temporary.path("s"), small_plan(), {}, true), Error);
  EXPECT_THROW(StudyFolder{temporary.path("t")}, Error);
}

TEST(StudyFolder, KeepsAnswers) {
  TempFolder temporary;
  StudyFolder made = StudyFolder::make(temporary.path("s"), small_plan(), {}, false);
  made.enter({"P01", 0, false, {}});
  EXPECT_TRUE(made.answers("P01").empty());
  made.write_answers("P01", {{"helped", "4"}, {"strategy", "slowly, \"then\" fast"}});
  EXPECT_EQ(made.answers("P01").at("helped"), "4");
  EXPECT_EQ(made.answers("P01").at("strategy"), "slowly, \"then\" fast");
}

TEST(PackedText, RefusesWhatIsDamaged) {
  TempFolder folder;
  const std::string gz = packed("some text that is packed and packed and packed");
  folder.write("cut.gz", gz.substr(0, gz.size() - 9));
  std::string other = gz;
  other[gz.size() / 2] = static_cast<char>(other[gz.size() / 2] ^ 0x55);
  folder.write("other.gz", other);
  folder.write("good.gz", gz);
  EXPECT_THROW((void)unpacked_file(folder.path("cut.gz").string()), Error);
  EXPECT_THROW((void)unpacked_file(folder.path("other.gz").string()), Error);
  EXPECT_THROW((void)unpacked_file(folder.path("good.gz").string(), 10), Error);
  EXPECT_EQ(unpacked_file(folder.path("good.gz").string()).substr(0, 4), "some");
}

}  // namespace
}  // namespace palpate::test
