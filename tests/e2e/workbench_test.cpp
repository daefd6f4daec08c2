// `workbench`, run as a user runs it.

#include <cmath>

#include "tests/e2e/explorer_test.h"

namespace palpate::test {
namespace {

class Workbench : public ExplorerTest {
 protected:
  Workbench() : ExplorerTest("workbench") {}
};

TEST_F(Workbench, HelpsWithExamples) {
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"--help"}, {"calibrate", "--help"}, {"screen", "-h"}, {"stability", "-h"}}) {
    const ProgramResult result = run(arguments);
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_NE(result.out.find("Examples:"), std::string::npos) << arguments[0];
    EXPECT_NE(result.out.find("  workbench "), std::string::npos) << arguments[0];
  }
}

// A table that `example` writes gives what `--example` gives, and every section lands in one file.
TEST_F(Workbench, CalibratesEveryKindFromATableIntoOneFile) {
  folder_.write("workbench.toml", "# ours\n[room]\nname = 'B 12'\n");
  for (const char* kind : {"tracker", "apparatus", "arm", "coregister", "pivot", "eyes"}) {
    SCOPED_TRACE(kind);
    EXPECT_EQ(run({"example", kind, "--out", "table.csv", "--force"}).exit_code, 0);
    const Json from_table = json({"calibrate", kind, "table.csv", "--out", "workbench.toml"});
    const Json made = json({"calibrate", kind, "--example"});
    EXPECT_EQ(from_table["measurements"], made["measurements"]);
    ASSERT_EQ(from_table["errors"].size(), made["errors"].size());
    for (std::size_t i = 0; i < made["errors"].size(); ++i) {
      EXPECT_NEAR(from_table["errors"][i]["mean"].get<double>(), made["errors"][i]["mean"].get<double>(),
                  1e-6);
    }
    EXPECT_EQ(run({"calibrate", kind, "table.csv", "--out", "workbench.toml"}).exit_code, 2);  // it is there
  }
  const std::string text = read_file(folder_.path("workbench.toml"));
  EXPECT_TRUE(text.starts_with("# ours\n[room]\nname = 'B 12'\n"));
  for (const char* section : {"[tracker]", "[apparatus]", "[arm]", "[coregistration]", "[stylus]", "[eyes]"})
    EXPECT_NE(text.find(section), std::string::npos) << section;
  // What was written can be started from.
  EXPECT_EQ(run({"calibrate", "arm", "--example", "--nominal", "workbench.toml"}).exit_code, 0);
}

TEST_F(Workbench, MakesAReportWithoutHardwareAndWithoutArguments) {
  EXPECT_EQ(run({}).exit_code, 0);
  EXPECT_EQ(run({}).exit_code, 0);  // and replaces its own
  EXPECT_EQ(files(), std::vector<std::string>{"workbench-report"});
  const std::string page = read_file(folder_.path("workbench-report/index.html"));
  for (const char* word :
       {"head_errors.svg", "tracker_position.svg", "printed: degree 4", "Condition number"})
    EXPECT_NE(page.find(word), std::string::npos) << word;
  for (const std::string picture : {"distortion_lines.png", "orientation_icons.png", "field_icons.png"}) {
    EXPECT_NE(page.find(picture), std::string::npos) << picture;
    EXPECT_TRUE(read_file(folder_.path("workbench-report/" + picture)).starts_with("\x89PNG")) << picture;
  }
}

TEST_F(Workbench, SaysWhatIsWrong) {
  EXPECT_EQ(run({"calibrate", "nose", "a.csv"}).exit_code, 2);
  EXPECT_EQ(run({"calibrate", "arm"}).exit_code, 2);
  EXPECT_EQ(run({"calibrate", "arm", "none.csv"}).exit_code, 3);
  EXPECT_EQ(run({"screen", "--distance", "-1"}).exit_code, 2);
  folder_.write("bad.csv", "px,py,pz,qw,qx,qy,qz\n0,0,0,1,0,0,0\n0,0,0,2,0,0,0\n");
  const ProgramResult bad = run({"calibrate", "pivot", "bad.csv"});
  EXPECT_EQ(bad.exit_code, 3);
  EXPECT_NE(bad.err.find("line 3"), std::string::npos) << bad.err;
  folder_.write("far.csv", "px,py,pz,qw,qx,qy,qz\n0,1e300,0,1,0,0,0\n");
  const ProgramResult far = run({"calibrate", "pivot", "far.csv"});
  EXPECT_EQ(far.exit_code, 3);
  EXPECT_NE(far.err.find("below 1000"), std::string::npos) << far.err;
  folder_.write("broken.toml", "[arm\n");
  EXPECT_EQ(run({"calibrate", "pivot", "--example", "--out", "broken.toml"}).exit_code, 3);
  EXPECT_EQ(read_file(folder_.path("broken.toml")), "[arm\n");
}

TEST_F(Workbench, DrawsTheDistortionOfATracker) {
  const ProgramResult drawn = run({"calibrate", "tracker", "--example", "--pictures", "pictures"});
  EXPECT_EQ(drawn.exit_code, 0) << drawn.err;
  for (const char* name : {"distortion_lines.png", "orientation_icons.png", "field_icons.png"}) {
    const std::string png = read_file(folder_.path(std::string("pictures/") + name));
    EXPECT_GT(png.size(), 20'000U) << name << ": a picture of something";
    EXPECT_TRUE(png.starts_with("\x89PNG")) << name;
  }
  EXPECT_EQ(run({"calibrate", "tracker", "--example", "--pictures", "pictures"}).exit_code,
            2);  // it is there
  EXPECT_EQ(run({"calibrate", "arm", "--example", "--pictures", "others"}).exit_code, 2);
}

// A device of a file stands beside the classes; its bound is that of theory.
TEST_F(Workbench, SweepsADeviceThatAFileDescribes) {
  folder_.write("arm.toml", "title = 'our arm'\nmass = 0.2\ndamping = 1.5\n");
  const Json table = json({"stability", "--model", "arm.toml", "--out", "stability"});
  ASSERT_FALSE(table["cases"].empty());
  EXPECT_GE(table["devices"].size(), 2U) << "beside the classes";
  for (const Json& each : table["cases"]) EXPECT_EQ(each["holds"], true) << each;
  bool found = false;
  for (const Json& each : table["devices"])
    found = found || std::abs(each["passive_n_per_m"].get<double>() - 3000.0) < 1e-6;
  EXPECT_TRUE(found) << table["devices"];
  folder_.write("bad.toml", "mass = 0.2\ndamping = -1\n");
  const ProgramResult bad = run({"stability", "--model", "bad.toml", "--out", "other"});
  EXPECT_EQ(bad.exit_code, 3);
  EXPECT_NE(bad.err.find("line 2"), std::string::npos) << bad.err;
  EXPECT_EQ(run({"stability", "--model", "omega", "--out", "other"}).exit_code, 2);
}

TEST_F(Workbench, HasTheCommandLineOfTheExplorers) {
  const Json out = json({"--seed", "3", "screen", "--distance", "0.5"});  // options may stand before the verb
  EXPECT_EQ(out["settings"]["distance"], 0.5);
  EXPECT_EQ(out["settings"]["seed"], 3);
  EXPECT_EQ(run({"nose"}).exit_code, 2);
  EXPECT_EQ(run({"example"}).exit_code, 2);
  EXPECT_EQ(run({"example", "arm"}).exit_code, 2);
  EXPECT_EQ(run({"stability"}).exit_code, 2);
  EXPECT_EQ(run({"screen", "--position-error", "5"}).exit_code, 2);
  EXPECT_EQ(run({"calibrate", "coregister", "--example", "--noise", "1,0,1"}).exit_code, 2);
  EXPECT_EQ(
      run({"calibrate", "tracker", "--example", "--method", "spline", "--out", "workbench.toml"}).exit_code,
      2);
  EXPECT_EQ(run({"example", "pivot", "-o", "table.csv", "-q"}).exit_code, 0);
  const std::string table = read_file(folder_.path("table.csv"));
  const ProgramResult over = run({"calibrate", "pivot", "table.csv", "--report", "table.csv", "--force"});
  EXPECT_EQ(over.exit_code, 2);
  EXPECT_NE(over.err.find("is the input"), std::string::npos) << over.err;
  EXPECT_EQ(read_file(folder_.path("table.csv")), table);
}

TEST_F(Workbench, ReadsOutTheEffectOfTrackingErrorsForAScreen) {
  const Json out = json({"screen", "--distance", "0.5", "--position-error", "10,0", "--behind", "0.5"});
  // Half a metre behind a screen half a metre away: the error itself (eq. 4.22).
  EXPECT_NEAR(out["points"][0]["z_m"].get<double>(), -0.5, 1e-12);
  EXPECT_NEAR(out["points"][0]["position_m"].get<double>(), 0.01, 1e-12);
}

}  // namespace
}  // namespace palpate::test
