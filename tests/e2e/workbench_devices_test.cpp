// `workbench devices|doctor|monitor`, run as a user runs them, on emulated devices; and what `calibrate`
// writes in their hands.

#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <sstream>

#include "tests/common/device/driver/fake_hd.h"
#include "tests/common/device/driver/polhemus/polhemus_emulator.h"
#include "tests/e2e/explorer_test.h"
#include "tests/support/project_folders.h"

namespace palpate::test {
namespace {

class WorkbenchDevices : public ExplorerTest {
 protected:
  WorkbenchDevices() : ExplorerTest("workbench") {}

  static Vec3 vector_of(const Json& json) { return {json[0], json[1], json[2]}; }
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
  // A force is asked for about a round after its sample; how long that is on this machine is no matter.
  EXPECT_GT(check["force_delay_ms_p50"].get<double>(), 0.0);
  EXPECT_GE(check["force_delay_ms_p99"].get<double>(), check["force_delay_ms_p50"].get<double>());
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
  const Json absent = parse_json(missing.out);
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

// From measurements of a tracker near metal to its poses without the distortion, by the one file.
TEST_F(WorkbenchDevices, CorrectATrackerByItsCalibration) {
  std::ostringstream rows;
  rows.precision(17);
  rows << "tx,ty,tz,tqw,tqx,tqy,tqz,mx,my,mz,mqw,mqx,mqy,mqz\n";
  std::mt19937 random{5};
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  for (int n = 0; n < 300; ++n) {
    const Vec3 place = Vec3(0.5, 0.0, 0.0) + 0.25 * Vec3{unit(random), unit(random), unit(random)};
    const TrackerPose actual{place, rotation_by({unit(random), unit(random), unit(random)})};
    const TrackerPose said = PolhemusEmulator::distorted(actual);
    for (const TrackerPose& pose : {said, actual}) {
      const auto& [p, q] = pose;
      if (rows.str().back() != '\n') rows << ",";
      rows << p.x << "," << p.y << "," << p.z << "," << q.w << "," << q.x << "," << q.y << "," << q.z;
    }
    rows << "\n";
  }
  folder_.write("poses.csv", rows.str());
  folder_.write("workbench.toml",
                "[stylus]\ntip = [0, 0, -0.12]\n\n[interaction]\ntechnique = \"immersive\"\n"
                "middle = [0.5, 0, 0]\nstylus_station = 2\nhand_station = 1\n");
  (void)json({"calibrate", "tracker", "poses.csv", "--degree", "4", "--out", "workbench.toml"});
  const Json seen = json({"monitor", "--device", "polhemus_emulated:still=1,metal=1", "--seconds", "1.5",
                          "--workbench", "workbench.toml"});
  const Json& stations = seen["samples"].back()["stations"];
  ASSERT_EQ(stations.size(), 2U) << seen;
  for (int station = 1; station <= 2; ++station) {
    const Json& told = stations[static_cast<std::size_t>(station - 1)];
    const Vec3 actual = PolhemusEmulator::position(station, 0.0);
    const double before = glm::distance(vector_of(told["position_m"]), actual);
    const double after = glm::distance(vector_of(told["corrected_position_m"]), actual);
    EXPECT_GT(before, 0.015) << station;
    EXPECT_LT(after, 0.1 * before) << station;
    const Json& q = told["corrected_rotation_wxyz"];
    const Quat turned{q[0], q[1], q[2], q[3]};
    EXPECT_LT(angle_of(turned * glm::conjugate(PolhemusEmulator::orientation(station, 0.0))), 0.3 * kDegree);
  }
  const Vec3 tip =
      PolhemusEmulator::position(2, 0.0) + PolhemusEmulator::orientation(2, 0.0) * Vec3(0.0, 0.0, -0.12);
  EXPECT_LT(glm::distance(vector_of(stations[1]["tip_m"]), tip), 0.003);
  EXPECT_FALSE(stations[0].contains("tip_m"));
}

/// Readings of the worn arm of the stand-in with its tip at `p` in its frame 0: x forward, y right, z up, in
/// the axis of the base. By the law of cosines.
std::array<double, 3> readings_at(const Vec3& p) {
  constexpr std::array kOff{0.06, -0.05, 0.08};
  const double out = std::hypot(p.x, p.y);
  const double elbow = std::acos((out * out + p.z * p.z - kFakeThigh * kFakeThigh - kFakeShin * kFakeShin) /
                                 (2.0 * kFakeThigh * kFakeShin));
  const double lift = std::atan2(p.z, out) +
                      std::atan2(kFakeShin * std::sin(elbow), kFakeThigh + kFakeShin * std::cos(elbow));
  return {std::atan2(p.y, p.x) - kOff[0], lift - kOff[1], -elbow - kOff[2]};
}

// From a grid that the tip was put on to the place of the arm, by its joints, in its frame and the tracker's.
TEST_F(WorkbenchDevices, PutAnArmWhereItsCalibratedJointsSay) {
  std::ostringstream rows;
  rows.precision(17);
  rows << "x,y,z,j1,j2,j3,j4,j5,j6\n";
  for (const double x : {0.18, 0.22, 0.26, 0.30}) {
    for (const double y : {-0.1, -0.05, 0.0, 0.05, 0.1}) {
      for (const double z : {-0.05, 0.0, 0.06}) {
        const auto angles = readings_at({x, y, z});
        rows << x << "," << y << "," << z << "," << angles[0] << "," << angles[1] << "," << angles[2]
             << ",0,0,0\n";
      }
    }
  }
  folder_.write("grid.csv", rows.str());
  std::ostringstream nominal;
  nominal << "[arm]\nrows = [[0, 0, " << 0.5 * std::numbers::pi << ", 0, 0, 1], [0, " << kFakeThigh
          << ", 0, 0, 0, 2], [0, " << kFakeShin
          << ", 0, 0, 0, 3], [0, 0, 0, 0, 0, 4], [0, 0, 0, 0, 0, 5], [0, 0, 0, 0, 0, 6]]\n"
             "free = [\"gamma\", \"gamma\", \"gamma\", \"\", \"\", \"\"]\n";
  folder_.write("nominal.toml", nominal.str());
  folder_.write("workbench.toml",
                "[interaction]\narm_rotation = [0.5, -0.5, -0.5, -0.5]\narm_middle = [0.24, 0, 0]\n\n"
                "[coregistration]\nrotation = [0.6, 0, 0.8, 0]\ntranslation = [0.5, 0.1, -0.2]\n"
                "sensor = [0, 0, 0]\n");
  (void)json(
      {"calibrate", "arm", "grid.csv", "--nominal", "nominal.toml", "--offsets", "--out", "workbench.toml"});
  const std::string device =
      "openhaptics:name=Worn arm,library=" + (build_folder() / "tests/libpalpate_fake_hd.so").string();
  const Json bare = json({"monitor", "--device", device, "--seconds", "0.5"});
  const Json seen =
      json({"monitor", "--device", device, "--seconds", "0.5", "--workbench", "workbench.toml"});
  const Vec3 actual{0.03, -0.02, 0.04};
  const Json& sample = seen["samples"].back();
  EXPECT_GT(glm::distance(vector_of(bare["samples"].back()["position_m"]), actual), 0.015);
  EXPECT_LT(glm::distance(vector_of(sample["position_m"]), actual), 1e-5);
  EXPECT_EQ(sample["joints_rad"].size(), 6U);
  const Vec3 in_arm{0.24 + actual.z, actual.x, actual.y};
  EXPECT_LT(glm::distance(vector_of(sample["arm_position_m"]), in_arm), 1e-5);
  const Vec3 at_workbench = Quat{0.6, 0.0, 0.8, 0.0} * in_arm + Vec3(0.5, 0.1, -0.2);
  EXPECT_LT(glm::distance(vector_of(sample["bench_position_m"]), at_workbench), 1e-5);
  // A device that tells no joints goes by its own word, and that is said.
  const ProgramResult falcon =
      run({"monitor", "--device", "falcon_emulated", "--seconds", "0.2", "--workbench", "workbench.toml"});
  EXPECT_EQ(falcon.exit_code, 0) << falcon.err;
  EXPECT_NE(falcon.err.find("tells none"), std::string::npos) << falcon.err;
}

}  // namespace
}  // namespace palpate::test
