// A trial of a simulated participant, its recording and its replay, on a field in closed form.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <iostream>
#include <memory>
#include <numbers>

#include <gtest/gtest.h>
#include <unistd.h>

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
#include "tests/support/uniformity.h"

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

/// A fall straight down onto the ground plane: its stiffness is the slope of the force below the plane, where the drag
/// is as good as constant and a vertical streamline gives none.
TEST(PathTrial, TheGroundPlaneIsEquallyStiffInBothConditions) {
  auto stimulus = std::make_shared<PathStimulus>();
  const Box box{Vec3{0.0}, Vec3{0.25}};
  stimulus->field = grid_field({3, 3, 3}, box, std::vector<Vec3>(27, Vec3{0.0, 0.0, -1.0}));
  for (int i = 0; i <= 100; ++i) stimulus->path.emplace_back(0.125, 0.125, 0.2 - 0.001 * i);
  stimulus->goal = PathGoal::kPlane;
  stimulus->shown = false;
  stimulus->bounds = box;
  PathTrial trial(stimulus);
  for (const double guidance : {0.5, 1.0}) {
    for (const double most : {40.0, 250.0, HUGE_VAL}) {
      for (const bool guided : {false, true}) {
        const auto chain = chain_of(trial, chain_text({"made", 0, guided, guidance, most}));
        const auto push = [&](double depth) { return chain->step(Vec3{0.125, 0.125, 0.1 - depth}).force.z; };
        for (double depth = -0.1; depth < 0.0; depth += 0.001) {
          const double drag = guided ? 0.0 : std::min(60.0 * guidance, most) * 0.004;
          EXPECT_LE(push(depth), drag + 1e-9) << "above the plane nothing but the drag is felt";
        }
        const double upper = push(0.008), lower = push(0.012);
        EXPECT_NEAR((lower - upper) / 0.004, std::min(400.0 * guidance, most), 0.5)
            << condition_name(guided) << " " << guidance << " " << most;
      }
    }
  }
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
  const std::string text = "ANISO 1 inf\n", softer = "ANISO 0.5 inf\n";
  ASSERT_NE(run.recording.find(text), std::string::npos);
  run.recording.replace(run.recording.find(text), text.size(), softer);
  TempFolder folder;
  folder.write("run.txt.gz", packed(run.recording));
  const TrialReplay again = replay_trial(trial, read_packed_recording(folder.path("run.txt.gz").string()));
  EXPECT_FALSE(again.identical);
  EXPECT_EQ(again.words.guidance, 0.5) << "it is told what the recording is of";
}

/// A device that bears less than the trial asks for gets less: force over distance is its stiffness.
TEST(SimulatedTrial, NoChainIsStifferThanTheDeviceBears) {
  PathTrial trial(circle_stimulus(PathGoal::kCircle, false));
  const Vec3 off = trial.start() + Vec3{0.004, 0.0, 0.0};
  for (const double most : {100.0, 250.0}) {
    const auto held = chain_of(trial, start_text(most));
    EXPECT_NEAR(glm::length(held->step(off).force), 0.004 * most, 0.01 * most * 0.004);
    EXPECT_EQ(chain_of(trial, chain_text({"made", 0, true, 1.0, most}))->settings().stiffness, most);
    EXPECT_EQ(chain_of(trial, chain_text({"made", 0, false, 1.0, most}))->settings().stiffness, 60.0);
  }
  EXPECT_EQ(chain_of(trial, start_text(HUGE_VAL))->settings().stiffness, 400.0);
  EXPECT_THROW((void)chain_of(trial, "start"), Error);
  EXPECT_THROW((void)chain_of(trial, "start nan"), Error);
}

TEST(SimulatedTrial, CountsStepsThatTellNothing) {
  std::vector<HandStep> steps(20);
  EXPECT_FALSE(flaws_of(steps, 0).any());
  steps[0].cut = ForceCut::kStart;
  steps[1].cut = ForceCut::kJump;
  EXPECT_FALSE(flaws_of(steps, 0).any()) << "forces that grow from zero are as they should be";
  steps[2].cut = ForceCut::kStale;
  steps[3].state = HoldState::kFault;
  steps[4].cut = ForceCut::kTooFast;
  steps[5].cut = ForceCut::kOutOfReach;
  steps[6].cut = steps[7].cut = ForceCut::kSwitchedOff;
  const TrialFlaws flaws = flaws_of(steps, 9);
  EXPECT_EQ(flaws.faults, 3U);
  EXPECT_EQ(flaws.cut, 1U);
  EXPECT_EQ(flaws.off, 2U);
  EXPECT_EQ(flaws.lost, 9U);
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
  const ChainWords bounded{"tracing3d", 12, true, 0.1, 312.5};
  EXPECT_EQ(chain_words(chain_text(bounded)), bounded);
  const ChainWords words = chain_words(chain_text({"tracing3d", 12, true, 0.1}));
  EXPECT_EQ(words.most_stiffness, HUGE_VAL);
  EXPECT_EQ(words.task, "tracing3d");
  EXPECT_EQ(words.stimulus, 12);
  EXPECT_TRUE(words.guided);
  EXPECT_EQ(words.guidance, 0.1);
  for (const char* bad : {"", "start", "trial a b ISO 1 inf", "trial a -1 ISO 1 inf", "trial a 1 ISO nan inf",
                          "trial a 1 ISO 1 nan", "trial a 1 ISO 1 -1", "trial a 1 ISO inf inf",
                          "trial a 1 NOISE 1 inf", "trial a 1 ISO 1"})
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

/// A trial that is kept in a folder of its own, and its files.
struct KeptTrial {
  KeptTrial() : made(StudyFolder::make(temporary.path("s"), small_plan(), {}, false)) {
    made.enter(who);
    first = made.left_for(who).front();
    record = {"P01",        "made", first.trial + 1, first.stimulus, first.practice,
              first.guided, true,   "simulated"};
    record.outcome.seconds = 2.0;
    record.outcome.error = 3.0;
    steps.resize(2);
  }
  void write() { made.write(record, "text", steps); }
  [[nodiscard]] std::string file() const {
    return "s/sub-P01/beh/sub-P01_task-made_run-" + std::string(first.trial + 1 < 10 ? "0" : "") +
           std::to_string(first.trial + 1) + "_beh.json";
  }

  TempFolder temporary;
  StudyFolder made;
  StudyParticipant who{"P01", 0, true, {}};
  PlannedTrial first;
  TrialRecord record;
  std::vector<HandStep> steps;
};

TEST(StudyFolder, KeepsNoTrialWithoutStepsTimeOrError) {
  KeptTrial kept;
  for (const double bad : {double(NAN), HUGE_VAL}) {
    kept.record.outcome.seconds = bad;
    EXPECT_THROW(kept.write(), Error);
    kept.record.outcome.seconds = 2.0;
    kept.record.outcome.error = bad;
    EXPECT_THROW(kept.write(), Error);
    kept.record.outcome.error = 3.0;
  }
  kept.steps.clear();
  EXPECT_THROW(kept.write(), Error);
  EXPECT_EQ(kept.made.left_for(kept.who).size(), 3U);
  EXPECT_TRUE(kept.made.trials().empty()) << "and the folder is still read";
  kept.steps.resize(2);
  kept.record.outcome.flaws = {1, 2, 3, 4};
  kept.record.most_stiffness = 250.0;
  kept.write();
  const TrialRecord again = kept.made.trials().at(0);
  EXPECT_EQ(again.outcome.flaws.off, 4U);
  EXPECT_EQ(again.outcome.flaws.lost, 1U);
  EXPECT_EQ(again.most_stiffness, 250.0);
}

TEST(StudyFolder, RefusesTrialsThatAreNotThoseOfTheDesign) {
  KeptTrial kept;
  kept.write();
  const std::string text = read_file(kept.temporary.path(kept.file()));
  ASSERT_EQ(kept.made.trials().size(), 1U);
  const std::string condition = kept.first.guided ? "\"ANISO\"" : "\"ISO\"";
  for (const auto& [from, to] : std::vector<std::pair<std::string, std::string>>{
           {condition, kept.first.guided ? "\"ISO\"" : "\"ANISO\""},
           {condition, "\"iso\""},
           {"\"practice\"", "\"recorded\""},
           {"\"practice\"", "\"rehearsal\""},
           {"\"space\"", "\"spacebar\""},
           {"\"run\": 1", "\"run\": 1.5"},
           {"\"run\": 1", "\"run\": 4294967297"},
           {"\"first_step\": 0", "\"first_step\": -1"},
           {"\"completion_time\": 2.0", "\"completion_time\": null"},
           {"\"completion_time\": 2.0", "\"completion_time\": -2.0"},
           {"\"simulated\": true", "\"simulated\": false"},
           {"\"off_steps\": 0", "\"off_steps\": 1e300"}}) {
    std::string other = text;
    ASSERT_NE(other.find(from), std::string::npos) << from << text;
    other.replace(other.find(from), from.size(), to);
    kept.temporary.write(kept.file(), other);
    EXPECT_THROW((void)kept.made.trials(), Error) << to;
  }
}

TEST(StudyFolder, EntersNobodyWithoutAFolder) {
  TempFolder temporary;
  StudyFolder made = StudyFolder::make(temporary.path("s"), small_plan(), {}, false);
  const StudyParticipant who{"P01", 0, false, {}};
  made.enter(who);
  std::filesystem::remove_all(temporary.path("s/sub-P01"));  // as a crash between two steps left it
  made.enter(who);
  EXPECT_TRUE(std::filesystem::is_directory(temporary.path("s/sub-P01/beh")));
}

TEST(StudyFolder, RefusesPlansBeyondItsLimits) {
  const auto refused = [](const std::function<void(StudyPlan&)>& change) {
    StudyPlan plan = small_plan();
    change(plan);
    EXPECT_THROW(StudyFolder::check(plan), Error);
    TempFolder temporary;
    EXPECT_THROW((void)StudyFolder::make(temporary.path("s"), plan, {}, false), Error);
  };
  EXPECT_NO_THROW(StudyFolder::check(small_plan()));
  refused([](StudyPlan& p) {
    p.tasks = {"made", "other", "made"};
    p.design.tasks = 3;
  });
  refused([](StudyPlan& p) { p.guidance = 11.0; });
  refused([](StudyPlan& p) { p.guidance = NAN; });
  refused([](StudyPlan& p) {
    p.design.participants = 10'000;
    p.design.practice = p.design.recorded = 300;
  });
}

TEST(StudyFolder, IsHeldByOneSession) {
  TempFolder temporary;
  const StudyFolder made = StudyFolder::make(temporary.path("s"), small_plan(), {}, false);
  const StudyFolder other(temporary.path("s"));
  {
    const StudyLock session = made.hold(StudyLock::Kind::kShared, "a session");
    const StudyLock place = made.hold_place(0, "study run of P01");
    EXPECT_NO_THROW((void)other.hold(StudyLock::Kind::kShared, "another"));
    EXPECT_NO_THROW((void)other.hold_place(1, "another"));
    EXPECT_THROW((void)other.hold(StudyLock::Kind::kAlone, "simulate"), Error);
    try {
      (void)other.hold_place(0, "another");
      ADD_FAILURE() << "the place is taken";
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find("study run of P01 (process " + std::to_string(::getpid())),
                std::string::npos)
          << error.what();
    }
  }
  EXPECT_NO_THROW((void)other.hold_place(0, "another"));
}

TEST(StudyFolder, RefusesAPlanThatWouldNotFitIntoMemory) {
  TempFolder temporary;
  (void)StudyFolder::make(temporary.path("s"), small_plan(), {}, false);
  const std::string plan = read_file(temporary.path("s/study.json"));
  for (const auto& [from, to] :
       {std::pair{"\"participants\": 2", "\"participants\": 2000000000"},
        std::pair{"\"participants\": 2", "\"participants\": 4294967298"},
        std::pair{"\"participants\": 2", "\"participants\": 2.5"},
        std::pair{"\"made\"\n", "\"made\", \"made\"\n"},
        std::pair{"\"guidance\": 1.0", "\"guidance\": 1e300"},
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
