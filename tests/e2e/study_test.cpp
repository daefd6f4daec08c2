// `study` of all programs: from the design to the analysis, with simulated participants.

#include <algorithm>
#include <filesystem>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "tests/e2e/explorer_test.h"

namespace palpate::test {
namespace {

class FlowStudy : public ExplorerTest {
 protected:
  FlowStudy() : ExplorerTest("flow") {}
};

TEST_F(FlowStudy, GoesFromDesignToAnalysis) {
  const Json made = json({"study", "make", "s", "--tasks", "advection2d", "--participants", "4", "--practice",
                          "1", "--recorded", "4", "--seed", "5"});
  EXPECT_EQ(made["trials"], 20);
  for (const auto& [what, difference] : made["imbalance"].items()) EXPECT_EQ(difference, 0) << what;
  for (const char* file : {"dataset_description.json", "design.tsv", "task-advection2d_beh.json",
                           "task-advection2d_motion.json", "stimuli/task-advection2d_stimuli.json",
                           "participants.json", "stimuli/task-advection2d_stimuli.tsv", "README"})
    EXPECT_TRUE(std::filesystem::exists(folder_.path("s") / file)) << file;

  EXPECT_EQ(json({"study", "simulate", "s", "--participant", "P02"})["trials"], 5);
  EXPECT_EQ(json({"study", "simulate", "s"})["trials"], 15) << "those that are there stay";
  const Json analysed = json({"study", "analyse", "s"});
  EXPECT_EQ(analysed["participants"], 4);
  EXPECT_EQ(analysed["simulated"], 4);
  EXPECT_GT(analysed["tasks"]["advection2d"]["difference_mm"].get<double>(), 0.0) << "guidance helps";
  const std::string page = read_file(folder_.path("s/analysis/index.html"));
  const std::size_t simulated = [&] {
    std::size_t count = 0;
    for (std::size_t at = page.find("imulated"); at != std::string::npos; at = page.find("imulated", at + 1))
      ++count;
    return count;
  }();
  EXPECT_GT(simulated, 10U) << "it is said in each section";
  for (const char* words : {"12.25, p &lt; 0.001", "2.65, p &lt; 0.016", "Shapiro", "Wilcoxon", "left out"})
    EXPECT_NE(page.find(words), std::string::npos) << words;
  const std::string trials = read_file(folder_.path("s/analysis/trials.csv"));
  EXPECT_EQ(std::count(trials.begin(), trials.end(), '\n'), 21);

  // Each column of a table has its words; what the page shows is in report.json with all digits.
  for (const char* table :
       {"s/analysis/trials", "s/analysis/participants", "s/stimuli/task-advection2d_stimuli"}) {
    const bool tabs = std::filesystem::exists(folder_.path(std::string(table) + ".tsv"));
    std::istringstream first(read_file(folder_.path(std::string(table) + (tabs ? ".tsv" : ".csv"))));
    const Json words = parse_json(read_file(folder_.path(std::string(table) + ".json")));
    std::string line, column;
    std::getline(first, line);
    std::size_t count = 0;
    for (std::istringstream columns(line); std::getline(columns, column, tabs ? '\t' : ','); ++count)
      EXPECT_FALSE(words.at(column).at("Description").get<std::string>().empty()) << table << " " << column;
    EXPECT_EQ(count, words.size()) << table;
  }
  std::set<std::string> kept;
  const Json report = parse_json(read_file(folder_.path("s/analysis/report.json")));
  for (const Json& m : report["measurements"])
    kept.insert(m["subject"].get<std::string>() + ": " + m["quantity"].get<std::string>());
  for (const char* number :
       {"trials: left out for error", "trials: left out for error or time, ISO",
        "position error: 95 % lower [mm]", "position error: d_av", "position error: half width ISO [mm]",
        "position error: W", "completion time: smaller sum of ranks", "correlation of error with time: r",
        "participants that the next study needs: for a power of 90 %", "questionnaire: answers"})
    EXPECT_TRUE(kept.contains(number)) << number;

  EXPECT_EQ(analysed["damaged_files"], 0);
  EXPECT_EQ(analysed["missing_trials"], 0);
  EXPECT_NE(page.find("not available as numbers"), std::string::npos) << "of the printed figures";
  EXPECT_TRUE(std::filesystem::exists(folder_.path("s/analysis/position_effects.svg")));

  const Json replayed = json({"study", "replay", "s", "--participant", "P03"});
  EXPECT_EQ(replayed["trials"], 5);
  EXPECT_EQ(replayed["differ"], 0);
  // A recording of another trial is told.
  const auto file = [&](const char* code) {
    return folder_.path("s/sub-" + std::string(code) + "/beh/sub-" + code +
                        "_task-advection2d_run-02_recording.txt.gz");
  };
  std::filesystem::copy_file(file("P03"), folder_.path("kept"));
  std::filesystem::copy_file(file("P02"), file("P03"), std::filesystem::copy_options::overwrite_existing);
  EXPECT_EQ(json({"study", "replay", "s", "--participant", "P03"}, 1)["differ"], 1);
  std::filesystem::copy_file(folder_.path("kept"), file("P03"),
                             std::filesystem::copy_options::overwrite_existing);
  // Stimuli that are not those of the folder are refused.
  std::string plan = read_file(folder_.path("s/study.json"));
  plan.replace(plan.find("\"seed\": 5"), 9, "\"seed\": 6");
  folder_.write("s/study.json", plan);
  const ProgramResult other = run({"study", "replay", "s", "--participant", "P03"});
  EXPECT_EQ(other.exit_code, 3);
  EXPECT_NE(other.err.find("other ones"), std::string::npos) << other.err;
}

TEST_F(FlowStudy, SaysWhatIsMissingOrTooFew) {
  const ProgramResult few = run({"study", "make", "s", "--tasks", "tracing2d", "--participants", "2",
                                 "--practice", "0", "--recorded", "2"});
  EXPECT_EQ(few.exit_code, 0);
  EXPECT_NE(few.err.find("--recorded 2 is too few"), std::string::npos) << few.err;
  (void)json({"study", "simulate", "s"});
  const std::string beh = "s/sub-P01/beh/sub-P01_task-tracing2d_run-0";
  std::filesystem::resize_file(folder_.path(beh + "1_recording.txt.gz"), 1000);
  std::filesystem::remove(folder_.path(beh + "1_motion.tsv.gz"));
  std::filesystem::remove(folder_.path(beh + "2_beh.json"));
  const ProgramResult analysed = run({"study", "analyse", "s", "--json"});
  EXPECT_EQ(analysed.exit_code, 0);
  EXPECT_EQ(parse_json(analysed.out)["damaged_files"], 2);
  EXPECT_EQ(parse_json(analysed.out)["missing_trials"], 1);
  const std::string page = read_file(folder_.path("s/analysis/index.html"));
  for (const std::string words :
       {"1_recording.txt.gz: it is damaged or cut off", "1_motion.tsv.gz: it is not there"}) {
    EXPECT_NE(analysed.err.find(words), std::string::npos) << analysed.err;
    EXPECT_NE(page.find(words), std::string::npos) << words;
  }
  EXPECT_NE(analysed.err.find("1 trial of the design"), std::string::npos) << analysed.err;
  const std::string trials = read_file(folder_.path("s/analysis/trials.csv"));
  EXPECT_NE(trials.find(",damaged\n"), std::string::npos) << trials;
}

TEST_F(FlowStudy, RefusesWhatMakesNoSense) {
  const auto refused = [&](const std::vector<std::string>& arguments, int code, const std::string& word) {
    const ProgramResult result = run(arguments);
    EXPECT_EQ(result.exit_code, code) << result.err;
    EXPECT_NE(result.err.find(word), std::string::npos) << result.err;
  };
  refused({"study"}, 2, "make, run");
  refused({"study", "make"}, 2, "folder");
  refused({"study", "dance", "s"}, 2, "dance");
  refused({"study", "make", "s", "--tasks", "juggling"}, 2, "tracing2d");
  refused({"study", "make", "s", "--recorded", "5"}, 2, "even");
  refused({"study", "make", "s", "--tasks", "tracing2d,tracing2d"}, 2, "twice");
  refused({"study", "make", "s", "--tasks", "tracing2d", "--recorded", "72", "--practice", "0"}, 2,
          "at most 70");
  refused({"study", "analyse", "nowhere"}, 3, "study make");
  folder_.write("full/file.txt", "mine");
  refused({"study", "make", "full", "--tasks", "tracing2d", "--practice", "0", "--recorded", "2",
           "--participants", "2"},
          2, "there already");
  EXPECT_EQ(run({"study", "make", "s", "--tasks", "tracing2d", "--practice", "0", "--recorded", "2",
                 "--participants", "2"})
                .exit_code,
            0);
  refused({"study", "analyse", "s"}, 3, "no trial yet");
  refused({"study", "run", "s", "--device", "replay:path.csv"}, 2, "is a file");
  refused({"study", "run", "s", "--device", "hands:hands.csv"}, 2, "is a file");
  refused({"study", "run", "s", "--participant", "P03"}, 2, "P01 to P02");
  refused({"study", "run", "s", "--participant", "P03", "--stereo", "anaglyph-grey"}, 2, "red line");
  EXPECT_FALSE(std::filesystem::exists(folder_.path("s/participants.tsv"))) << "nobody is entered by that";
  refused({"study", "simulate", "s", "--participant", "P09"}, 2, "P09");
  refused({"study", "replay", "s"}, 2, "no such trial");
}

class GridStudy : public ExplorerTest {
 protected:
  GridStudy() : ExplorerTest("grid") {}
};

/// A point that was marked lets go of the hand: nobody is held until the time is up, and all are in the analysis.
TEST_F(GridStudy, PointsLetGoOfTheHand) {
  (void)json(
      {"study", "make", "s", "--participants", "4", "--practice", "0", "--recorded", "4", "--seed", "1"});
  EXPECT_EQ(json({"study", "simulate", "s"})["timed_out"], 0);
  const Json found = json({"study", "analyse", "s"})["tasks"]["plane"];
  EXPECT_EQ(found["left_out"], 0) << found.dump();
  EXPECT_TRUE(found["t"].is_number()) << "null where it is not finite";
  EXPECT_TRUE(found["p"].is_number());
}

class OtherStudy : public ::testing::TestWithParam<std::pair<const char*, const char*>> {};

TEST_P(OtherStudy, RunsTheTaskOfItsProgram) {
  const auto& [program, task] = GetParam();
  TempFolder folder;
  const auto run = [&, name = std::string(program)](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), bin(name).string());
    arguments.emplace_back("--json");
    const ProgramResult result = Program(arguments, folder.path()).finish();
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return parse_json(result.out);
  };
  (void)run({"study", "make", "s", "--participants", "4", "--practice", "0", "--recorded", "4"});
  EXPECT_EQ(run({"study", "simulate", "s"})["trials"], 16);
  const Json analysed = run({"study", "analyse", "s"});
  EXPECT_GT(analysed["tasks"][task]["difference_mm"].get<double>(), 0.0)
      << "guidance helps: " << analysed.dump();
  EXPECT_EQ(run({"study", "replay", "s"})["differ"], 0);
}

INSTANTIATE_TEST_SUITE_P(Programs, OtherStudy,
                         ::testing::Values(std::pair{"grid", "plane"}, std::pair{"cardiac", "fibre"},
                                           std::pair{"dtmri", "bundle"}),
                         [](const auto& info) { return std::string(info.param.first); });

}  // namespace
}  // namespace palpate::test
