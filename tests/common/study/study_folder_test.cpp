// The folder of an experiment: what is kept, what is left, what is refused.
#include "common/study/study_folder.h"

#include <cmath>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <unistd.h>

#include "common/base/error.h"
#include "common/base/text.h"
#include "common/study/packed_text.h"
#include "common/study/participant_model.h"
#include "common/study/path_trial.h"
#include "common/study/study_damage.h"
#include "common/study/trial_run.h"
#include "tests/support/temp_folder.h"

namespace palpate::test {
namespace {

/// A line of 6 cm in the plane.
std::shared_ptr<const PathStimulus> straight_stimulus() {
  auto stimulus = std::make_shared<PathStimulus>();
  for (int i = 0; i <= 60; ++i) stimulus->path.emplace_back(0.05 + 0.001 * i, 0.1, 0.0);
  stimulus->flat = true;
  stimulus->bounds = {Vec3{0.0}, {0.25, 0.25, 0.0}};
  return stimulus;
}

StudyPlan small_plan() {
  StudyPlan plan{.program = "made", .version = "1", .tasks = {"made"}};
  plan.design = {.participants = 2, .tasks = 1, .practice = 1, .recorded = 2, .seed = 4};
  return plan;
}

TEST(StudyFolder, KeepsTrialsAndKnowsWhichAreLeft) {
  TempFolder temporary;
  StudyFolder made = StudyFolder::make(temporary.path("s"), small_plan(), {}, false);
  const std::vector<double> traits = values_of(draw_traits(4, 0));
  const StudyParticipant who{"P01", 0, true, traits};
  made.enter(who);
  ASSERT_EQ(made.left_for(who).size(), 3U);
  const PlannedTrial first = made.left_for(who).front();
  PathTrial trial(straight_stimulus());
  const RecordingHeader header;
  const TrialRun run =
      simulate_trial(trial, {.name = "made", .title = "Made", .flat = true}, {"made", 0, first.guided, 1.0},
                     draw_traits(1, 1), RandomStream({5, 1}), &header);
  made.write({"P01", "made", first.trial + 1, first.stimulus, first.practice, first.guided, true, "simulated",
              run.outcome},
             run.recording, run.steps);
  const StudyFolder again(temporary.path("s"));
  EXPECT_EQ(again.left_for(who).size(), 2U);
  EXPECT_EQ(again.plan().design.seed, 4U);
  EXPECT_EQ(again.participants().at(0).traits, traits) << "all digits";
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

TEST(StudyDamage, IsOfFilesThatAreGoneOrCutOff) {
  KeptTrial kept;
  kept.made.write(kept.record, "steps\nend 2\n", kept.steps);
  Progress progress;
  const auto damaged = [&] { return damaged_files(kept.made, kept.made.trials(), progress, 1); };
  EXPECT_TRUE(damaged().empty());
  const std::string stem = kept.file().substr(0, kept.file().size() - std::string("beh.json").size());
  const std::filesystem::path recording = kept.temporary.path(stem + kRecordingFile),
                              motion = kept.temporary.path(stem + kMotionFile);
  std::filesystem::resize_file(recording, std::filesystem::file_size(recording) - 9);
  ASSERT_EQ(damaged().size(), 1U);
  EXPECT_EQ(damaged()[0].file, stem.substr(2) + kRecordingFile);
  EXPECT_EQ(damaged()[0].why, "it is damaged or cut off");
  std::filesystem::remove(motion);
  ASSERT_EQ(damaged().size(), 2U);
  EXPECT_EQ(damaged()[1].why, "it is not there");
  EXPECT_EQ(damaged()[1].run, kept.record.run);
  // Packed anew without its end.
  kept.temporary.write(stem + kRecordingFile, packed("steps\n"));
  EXPECT_EQ(damaged().size(), 2U);
  kept.temporary.write(stem + kRecordingFile, "");
  EXPECT_EQ(damaged().size(), 2U);
}

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

/// Trials with flaws come again at the end of their block, practice and recorded ones apart, a few times.
TEST(StudyFolder, RepeatsTrialsWithFlawsAtTheEndOfTheirBlock) {
  TempFolder temporary;
  StudyPlan plan = small_plan();
  plan.design.practice = 2;
  plan.design.recorded = 4;
  StudyFolder made = StudyFolder::make(temporary.path("s"), plan, {}, false);
  const StudyParticipant who{"P01", 0, false, {}};
  made.enter(who);
  const std::vector<HandStep> steps(2);
  const auto next = [&] { return made.left_for(who).front(); };
  const auto do_next = [&](bool flawed) {
    const PlannedTrial t = next();
    TrialRecord record{"P01", "made", made.run_of(t), t.stimulus, t.practice, t.guided, false, "mouse"};
    record.outcome.seconds = record.outcome.error = 1.0;
    record.outcome.flaws.cut = flawed ? 5 : 0;
    record.attempt = t.attempt;
    made.write(record, "text", steps);
  };
  do_next(true);
  EXPECT_EQ(made.left_for(who).size(), 6U);
  EXPECT_EQ(made.run_of(next()), 2);
  do_next(false);
  EXPECT_EQ(made.run_of(next()), 7) << "the first one again, before recorded trials begin";
  EXPECT_EQ(next().attempt, 1);
  do_next(true);
  EXPECT_EQ(made.run_of(next()), 13) << "and once more";
  do_next(true);
  EXPECT_EQ(made.run_of(next()), 3) << "not more often than kMostAttempts";
  do_next(false);
  do_next(true);
  do_next(false);
  do_next(false);
  EXPECT_EQ(made.run_of(next()), 10) << "the fourth";
  do_next(false);
  EXPECT_TRUE(made.left_for(who).empty());
  const std::vector<TrialRecord> trials = StudyFolder(temporary.path("s")).trials();
  ASSERT_EQ(trials.size(), 9U);
  EXPECT_EQ(trials[0].run, 1);
  EXPECT_EQ(trials[1].run, 7) << "repeats follow what they repeat";
  EXPECT_EQ(trials[2].attempt, 2);
}

TEST(StudyFolder, HasADictionaryOfEachTable) {
  TempFolder temporary;
  const StudyFolder made = StudyFolder::make(temporary.path("s"), small_plan(), {}, false);
  StudyFolder(temporary.path("s")).enter({"P01", 0, true, values_of(draw_traits(1, 0))});
  for (const char* name : {"design", "participants"}) {
    const std::string table = read_file(made.path() / (std::string(name) + ".tsv")),
                      words = read_file(made.path() / (std::string(name) + ".json"));
    for (const std::string_view column : split(std::string_view(table).substr(0, table.find('\n')), '\t'))
      EXPECT_NE(words.find("\"" + std::string(column) + "\": {\n    \"Description\""), std::string::npos)
          << name << " " << column;
  }
}

TEST(StudyFolder, RefusesParticipantsThatMakeNoSense) {
  TempFolder temporary;
  StudyFolder made = StudyFolder::make(temporary.path("s"), small_plan(), {}, false);
  made.enter({"P01", 0, true, values_of(draw_traits(1, 0))});
  made.enter({"P02", 1, false, {}});
  ASSERT_EQ(made.participants().size(), 2U);
  EXPECT_TRUE(made.participants()[1].traits.empty());
  const std::string table = read_file(temporary.path("s/participants.tsv"));
  for (const auto& [from, to] :
       {std::pair{"sub-P01", "P01"}, std::pair{"sub-P01", "sub-../x"}, std::pair{"\t0\t", "\t2\t"},
        std::pair{"\t0\t", "\t-1\t"}, std::pair{"false", "maybe"}, std::pair{"n/a\t", ""},
        std::pair{"number", "place"}}) {
    std::string other = table;
    ASSERT_NE(other.find(from), std::string::npos) << from;
    other.replace(other.find(from), std::string(from).size(), to);
    temporary.write("s/participants.tsv", other);
    EXPECT_THROW((void)made.participants(), Error) << to;
  }
}

TEST(StudyFolder, RefusesADesignThatIsAnotherOne) {
  TempFolder temporary;
  const StudyFolder made = StudyFolder::make(temporary.path("s"), small_plan(), {}, false);
  std::string table = read_file(temporary.path("s/design.tsv"));
  table.replace(table.find("ANISO"), 5, "ISO");
  temporary.write("s/design.tsv", table);
  EXPECT_THROW(StudyFolder{made.path()}, Error);
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
