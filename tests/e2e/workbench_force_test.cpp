// `workbench feel|tune`, run as a user runs them, on simulated arms and an emulated Falcon.

#include <cmath>
#include <sstream>

#include "tests/e2e/explorer_test.h"

namespace palpate::test {
namespace {

class WorkbenchForce : public ExplorerTest {
 protected:
  WorkbenchForce() : ExplorerTest("workbench") {
    // Into the wall z < 0, 6 mm deep, along it, and out again; a row a step.
    std::ostringstream path;
    path << "t,x,y,z\n";
    for (int i = 0; i <= 3000; ++i) {
      const double t = 1e-3 * i;
      path << t << "," << 0.01 * t << ",0," << 0.006 * std::cos(2.0 * 3.14159265358979 * t / 3.0) << "\n";
    }
    folder_.write("hand.csv", path.str());
  }

  /// What `feel` says; it has failed where one of its cases has.
  Json felt(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "feel");
    arguments.emplace_back("--json");
    const ProgramResult result = run(arguments);
    Json object = parse_json(result.out);
    EXPECT_TRUE(object.is_object()) << result.out << result.err;
    bool holds = true;
    for (const Json& each : object["cases"]) holds = holds && each["holds"].get<bool>();
    EXPECT_EQ(result.exit_code, holds ? 0 : 1) << result.out << result.err;
    return object;
  }
};

TEST_F(WorkbenchForce, JudgesARecordedHand) {
  const Json soft = json({"feel", "--path", "hand.csv", "--stiffness", "500", "--out", "log.csv"});
  EXPECT_EQ(soft["effect"], "wall");
  EXPECT_EQ(soft["steps"], 3001);
  EXPECT_NEAR(soft["deepest_m"].get<double>(), 0.006, 1e-6);
  EXPECT_NEAR(soft["max_force_n"].get<double>(), 3.0, 1e-3);
  EXPECT_NEAR(soft["shown_stiffness_n_per_m"].get<double>(), 500.0, 0.5);
  for (const Json& each : soft["cases"]) EXPECT_EQ(each["holds"], true) << each;
  const std::string log = read_file(folder_.path("log.csv"));
  EXPECT_TRUE(log.starts_with("t,x,y,z,px,py,pz,fx,fy,fz,state,residual,us")) << log.substr(0, 80);
  EXPECT_EQ(std::count(log.begin(), log.end(), '\n'), 3002);
  EXPECT_EQ(run({"feel", "--path", "hand.csv", "--out", "log.csv"}).exit_code, 2);  // it is there
  // 2000 N/m over 6 mm are more than the cap of 4 N: it is softer than that, and has failed.
  const ProgramResult hard = run({"feel", "--path", "hand.csv", "--stiffness", "2000"});
  EXPECT_EQ(hard.exit_code, 1);
  EXPECT_NE(hard.out.find("FAILS  stiffness shown"), std::string::npos) << hard.out;
  // On an arm that its hand moves, which lags and gives.
  const Json arm = felt({"--path", "hand.csv", "--device", "simulated:falcon", "--effect", "groove"});
  EXPECT_EQ(arm["device"], "simulated:falcon");
  EXPECT_GT(arm["steps_in_contact"].get<int>(), 1000);
  EXPECT_LT(arm["leak"].get<double>(), 0.02);
}

TEST_F(WorkbenchForce, FeelsALiveArmWithReadOuts) {
  const ProgramResult text = run({"feel", "--device", "simulated:falcon", "--seconds", "1", "--rate", "20"});
  EXPECT_EQ(text.exit_code, text.out.find("  FAILS  ") == std::string::npos ? 0 : 1) << text.out << text.err;
  EXPECT_NE(text.out.find(" mm in"), std::string::npos) << text.out;
  EXPECT_NE(text.out.find("new samples a second"), std::string::npos) << text.out;
  // It begins in free air, strokes into the effect and out again.
  const Json wall = felt({"--device", "simulated:falcon", "--seconds", "2.5"});
  const int contact = wall["steps_in_contact"], steps = wall["steps"];
  EXPECT_GT(contact, 0);
  EXPECT_LT(contact, steps * 4 / 5);
  EXPECT_LT(wall["free_force_n"].get<double>(), 0.05);
  // A real driver's device, here on an emulated wire: homed, then felt.
  const Json falcon =
      felt({"--device", "falcon_emulated:button=none", "--effect", "sphere", "--seconds", "3"});
  EXPECT_GT(falcon["sample_rate_hz"].get<double>(), 10.0);
  EXPECT_LE(falcon["max_force_n"].get<double>(), 8.0);
  EXPECT_GT(falcon["steps_in_contact"].get<int>(), 0);
}

TEST_F(WorkbenchForce, TunesAnArmForTheExplorers) {
  folder_.write("workbench.toml", "# ours\n");
  const Json tuned = json({"tune", "--device", "simulated:ideal", "--places", "1", "--most", "9000",
                           "--margin", "0.5", "--out", "workbench.toml"});
  // 2 b / T = 4000 N/m.
  EXPECT_NEAR(tuned["bound_n_per_m"].get<double>(), 4000.0, 1e-6);
  EXPECT_NEAR(tuned["stiffness_n_per_m"].get<double>(), 0.5 * 4000.0, 0.05 * 4000.0);
  EXPECT_EQ(tuned["places"].size(), 1U);
  const std::string file = read_file(folder_.path("workbench.toml"));
  EXPECT_TRUE(file.starts_with("# ours\n")) << file;
  EXPECT_NE(file.find("[tuned.\"simulated:ideal\"]"), std::string::npos) << file;
  EXPECT_EQ(run({"tune", "--device", "simulated:ideal", "--out", "workbench.toml"}).exit_code, 2);
  // What asks for more is held to it.
  const double found = tuned["stiffness_n_per_m"];
  const ProgramResult felt = run({"feel", "--path", "hand.csv", "--device", "simulated:ideal", "--stiffness",
                                  "5000", "--workbench", "workbench.toml", "--json"});
  EXPECT_LE(felt.exit_code, 1) << felt.err;
  EXPECT_NEAR(parse_json(felt.out)["stiffness_n_per_m"].get<double>(), found, 1e-9);
  EXPECT_NE(felt.err.find("tuning found"), std::string::npos) << felt.err;
}

TEST_F(WorkbenchForce, SaysWhatIsWrong) {
  EXPECT_EQ(run({"feel"}).exit_code, 2);
  EXPECT_EQ(run({"feel", "--device", "mouse"}).exit_code, 2);
  EXPECT_EQ(run({"feel", "--path", "none.csv"}).exit_code, 3);
  EXPECT_EQ(run({"feel", "--path", "hand.csv", "--effect", "nose"}).exit_code, 2);
  EXPECT_EQ(run({"tune", "--device", "simulated:ideal", "--places", "4"}).exit_code, 2);
  EXPECT_EQ(run({"tune", "--device", "simulated:ideal", "--least", "500", "--most", "400"}).exit_code, 2);
  // A Falcon's own button cannot be held while nobody holds the arm.
  const ProgramResult held = run({"tune", "--device", "falcon_emulated"});
  EXPECT_EQ(held.exit_code, 2);
  EXPECT_NE(held.err.find("enable=pedal"), std::string::npos) << held.err;
  folder_.write("bad.toml", "[device.falcon_emulated]\nthigh = -1\n");
  EXPECT_EQ(run({"feel", "--device", "falcon_emulated", "--workbench", "bad.toml"}).exit_code, 2);
  // An arm whose friction is above the knock tells nothing.
  const ProgramResult stuck =
      run({"tune", "--device", "simulated:falcon", "--knock", "0.2", "--places", "1"});
  EXPECT_EQ(stuck.exit_code, 1);
  EXPECT_NE(stuck.out.find("--knock"), std::string::npos) << stuck.out;
}

}  // namespace
}  // namespace palpate::test
