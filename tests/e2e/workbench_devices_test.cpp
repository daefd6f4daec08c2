// `workbench devices|doctor|monitor`, run as a user runs them, on an emulated Falcon.

#include "tests/e2e/explorer_test.h"

namespace palpate::test {
namespace {

class WorkbenchDevices : public ExplorerTest {
 protected:
  WorkbenchDevices() : ExplorerTest("workbench") {}
};

TEST_F(WorkbenchDevices, NamesWhatIsPluggedIn) {
  const Json seen = json({"devices"});
  ASSERT_GE(seen["drivers"].size(), 2U);
  EXPECT_EQ(seen["drivers"][0]["name"], "falcon");
  EXPECT_TRUE(seen["devices"].is_array());
  // The emulated one is on its bus only after it was plugged in, by the making of a link.
  const Json emulated = json({"devices", "--device", "falcon_emulated"});
  EXPECT_EQ(emulated["drivers"].back()["name"], "falcon_emulated");
  EXPECT_EQ(run({"devices", "--device", "nothing"}).exit_code, 2);
}

TEST_F(WorkbenchDevices, TheDoctorWaitsForHomingAndMeasures) {
  const Json seen = json({"doctor", "--device", "falcon_emulated", "--seconds", "1"});
  ASSERT_EQ(seen["checks"].size(), 1U);
  const Json& check = seen["checks"][0];
  EXPECT_EQ(seen["usable"], true);
  EXPECT_EQ(check["ready"], true);
  std::vector<std::string> phases;
  for (const Json& step : check["phases"]) phases.push_back(step["phase"]);
  EXPECT_EQ(phases.back(), "ready");
  EXPECT_NE(std::find(phases.begin(), phases.end(), "needs_homing"), phases.end());
  EXPECT_GT(check["rate_hz"].get<double>(), 10.0);
  EXPECT_GE(check["interval_ms_p99"].get<double>(), check["interval_ms_p50"].get<double>());
  EXPECT_EQ(check["faults"], 0);
  EXPECT_EQ(check["place"], "usb 1-2");
}

TEST_F(WorkbenchDevices, TheDoctorSaysWhatIsMissing) {
  const ProgramResult unloaded =
      run({"doctor", "--device", "falcon_emulated:loaded=0", "--seconds", "0.2", "--patience", "2"});
  EXPECT_EQ(unloaded.exit_code, 1) << unloaded.err;
  EXPECT_NE(unloaded.err.find("not all that was found can be used"), std::string::npos) << unloaded.err;
  EXPECT_NE(unloaded.out.find("needs_firmware"), std::string::npos) << unloaded.out;
  EXPECT_NE(unloaded.out.find("falcon:firmware=FILE"), std::string::npos) << unloaded.out;

  // And loads what it is given, with the number of tries.
  folder_.write("image.bin", std::string(1500, '\x5a'));
  const Json loaded =
      json({"doctor", "--device", "falcon_emulated:loaded=0,firmware=image.bin", "--seconds", "0.2"});
  EXPECT_EQ(loaded["checks"][0]["ready"], true);
  EXPECT_GE(loaded["checks"][0]["uploads"].get<int>(), 1);

  const ProgramResult missing =
      run({"doctor", "--device", "falcon_emulated:missing=1", "--patience", "0.3", "--json"});
  EXPECT_EQ(missing.exit_code, 1);
  const Json absent = Json::parse(missing.out);
  EXPECT_EQ(absent["usable"], false);
  EXPECT_EQ(absent["checks"][0]["ready"], false);
  EXPECT_NE(absent["advice"][0].get<std::string>().find("power supply"), std::string::npos);
}

TEST_F(WorkbenchDevices, TheMonitorReadsPositionsOut) {
  const Json seen = json({"monitor", "--device", "falcon_emulated", "--seconds", "2", "--rate", "20"});
  EXPECT_EQ(seen["phase"], "ready");
  ASSERT_GT(seen["samples"].size(), 3U);
  for (const Json& sample : seen["samples"]) {
    ASSERT_EQ(sample["position_m"].size(), 3U);
    for (const Json& x : sample["position_m"])
      ASSERT_LT(std::abs(x.get<double>()), 0.1);  // the arm reaches no farther
  }
  EXPECT_EQ(run({"monitor"}).exit_code, 2);
  const ProgramResult text = run({"monitor", "--device", "falcon_emulated", "--seconds", "2"});
  EXPECT_NE(text.out.find("mm   buttons none"), std::string::npos) << text.out;
  EXPECT_NE(text.err.find("pull the grip out"), std::string::npos) << text.err;
}

TEST_F(WorkbenchDevices, KnowATracker) {
  const Json checked = json({"doctor", "--device", "polhemus_emulated", "--seconds", "0.5"});
  EXPECT_EQ(checked["usable"], true) << checked;
  EXPECT_EQ(checked["checks"][0]["place"], "usb 1-3");
  EXPECT_GT(checked["checks"][0]["rounds"].get<int>(), 10);
  const Json seen = json({"monitor", "--device", "polhemus_emulated", "--seconds", "2", "--rate", "20"});
  ASSERT_GT(seen["samples"].size(), 3U);
  const Json& stations = seen["samples"].back()["stations"];
  ASSERT_EQ(stations.size(), 2U) << seen;
  EXPECT_EQ(stations[1]["station"], 2);
  EXPECT_NEAR(stations[0]["position_m"][0].get<double>(), 0.5, 0.11) << "where the emulated sensors are";
  const ProgramResult text = run({"monitor", "--device", "polhemus_emulated", "--seconds", "2"});
  EXPECT_NE(text.out.find("station 2"), std::string::npos) << text.out;
}

}  // namespace
}  // namespace palpate::test
