// `flow probe --device simulated`, run as a user runs it: a hand that wants to be on the path.

#include <cmath>
#include <string>
#include <vector>

#include "common/field/analytic/examples.h"
#include "common/field/vector_field.h"
#include "common/haptics/workspace.h"
#include "tests/e2e/explorer_test.h"
#include "tests/e2e/hand/probe_log.h"

namespace palpate::test {
namespace {

class SimulatedDeviceOnThePath : public ExplorerTest {
 protected:
  SimulatedDeviceOnThePath() : ExplorerTest("flow") {
    for (int n = 0; n <= 2000; ++n) {
      const double t = 0.001 * n;
      path_.push_back({t, {3.0 + std::sin(2.0 * t), 3.0, 3.0 + 0.5 * t}});
    }
    folder_.write("path.csv", path_table(path_));
  }

  ProbeLogText feel(const std::string& device, const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments{"probe", "--example", "abc",     "--path",   "path.csv",
                                       "--out", "log.csv",   "--force", "--device", device};
    arguments.insert(arguments.end(), more.begin(), more.end());
    last_ = run(arguments);
    EXPECT_EQ(last_.exit_code, 0) << last_.err;
    return read_probe_log(folder_.path("log.csv"));
  }

  std::vector<PathRow> path_;
  ProgramResult last_;
};

TEST_F(SimulatedDeviceOnThePath, FollowsWithTheOperatorsLagAndRepeatsToTheBit) {
  const std::vector<std::string> unfelt{"--stiffness", "0"};
  const ProbeLogText log = feel("simulated:ideal,hand=firm", unfelt);
  // To the end of the path, and a tenth of a second more until the last target is stale.
  ASSERT_NEAR(static_cast<double>(log.rows.size()), 2101.0, 2.0);
  const double scale = Workspace::default_scale(make_vector_field(example("abc"))->diagonal());
  double farthest = 0.0;  // [m] from where the target was 0.3 s ago
  for (std::size_t n = 500; n < 2000; ++n) {
    farthest = std::max(farthest, scale * glm::distance(log.rows[n].probe, path_[n - 300].position));
  }
  EXPECT_LT(farthest, 0.004);
  EXPECT_EQ(feel("simulated:ideal,hand=firm", unfelt).lines, log.lines);
  EXPECT_NE(feel("simulated:ideal,hand=relaxed", unfelt).lines, log.lines);
  std::vector<std::string> slower = unfelt;
  slower.insert(slower.end(), {"--rate", "500"});
  EXPECT_NEAR(static_cast<double>(feel("simulated:ideal,hand=firm", slower).rows.size()), 1051.0, 2.0);
}

TEST_F(SimulatedDeviceOnThePath, StartsGentlyAndWithinTheLimitsOfItsClass) {
  constexpr double kRamp = 0.5, kCap = 1.0, kSlew = 50.0;  // [s], [N], [N/s]
  const ProbeLogText log = feel("simulated:premium3", {"--force-cap", "1", "--slew-cap", "50"});
  Vec3 before{0.0};
  double largest = 0.0;
  for (std::size_t n = 0; n < log.rows.size(); ++n) {
    const LogRow& row = log.rows[n];
    const double force = glm::length(row.force);
    ASSERT_LE(force, kCap * std::min(1.0, 0.001 * static_cast<double>(n) / kRamp) + 1e-9) << n;
    // What grows or turns does so slowly; a drop may be immediate.
    if (force >= glm::length(before)) {
      ASSERT_LE(glm::distance(row.force, before), 0.001 * kSlew + 1e-9) << n;
    }
    before = row.force;
    largest = std::max(largest, force);
  }
  EXPECT_GT(largest, 0.5);
}

TEST_F(SimulatedDeviceOnThePath, ThereIsForceOnlyWhileTheEnablingButtonIsHeld) {
  std::string table = "t,x,y,z,b0\n";
  for (const PathRow& row : path_) {
    const bool held = row.time >= 0.5 && row.time < 1.5;
    table += std::to_string(row.time) + ',' + std::to_string(row.position.x) + ',' +
             std::to_string(row.position.y) + ',' + std::to_string(row.position.z) + (held ? ",1\n" : ",0\n");
  }
  folder_.write("path.csv", table);
  const ProbeLogText log = feel("simulated:premium3,button=0");
  constexpr double kFade = 0.06;  // [s] within which it has gone after the release, and a step
  double held = 0.0;
  for (const LogRow& row : log.rows) {
    if (row.time < 0.5 || row.time > 1.5 + kFade) {
      ASSERT_EQ(row.force, Vec3(0.0)) << row.time;
    } else {
      held = std::max(held, glm::length(row.force));
    }
  }
  EXPECT_GT(held, 0.1);
}

TEST_F(SimulatedDeviceOnThePath, AHandThatWasTooFastGetsNoForceAnyMore) {
  // A leap of 1.5 m. Before it the path takes 1.1 m/s at most.
  for (std::size_t n = 1000; n < path_.size(); ++n) path_[n].position += Vec3{0.0, 3.0, 0.0};
  folder_.write("path.csv", path_table(path_));
  const ProbeLogText log = feel("simulated:ideal,hand=firm", {"--workspace-scale", "0.5"});
  std::size_t first = 0;
  while (first < log.rows.size() && log.rows[first].state != "fault") ++first;
  ASSERT_LT(first, log.rows.size());
  EXPECT_GT(first, 1000U);
  for (std::size_t n = first; n < log.rows.size(); ++n) {
    ASSERT_EQ(log.rows[n].force, Vec3(0.0)) << n;
    ASSERT_EQ(log.rows[n].state, "fault") << n;
  }
  EXPECT_NE(last_.err.find("passed 1.5 m/s"), std::string::npos) << last_.err;
}

// What the line does to the hand shows in where the hand goes: a stiffer one holds it nearer.
TEST_F(SimulatedDeviceOnThePath, GivesWayToTheLineThatHoldsIt) {
  const auto stretch = [&](const char* stiffness) {
    double sum = 0.0;
    const ProbeLogText log = feel("simulated:ideal", {"--stiffness", stiffness, "--release", "1000"});
    for (const LogRow& row : log.rows) sum += glm::distance(row.probe, row.proxy);
    return sum;
  };
  EXPECT_LT(stretch("800"), 0.5 * stretch("100"));
}

TEST_F(SimulatedDeviceOnThePath, NamesTheLimitOfTheDevice) {
  (void)feel("simulated", {"--stiffness", "500"});
  EXPECT_NE(last_.err.find("a stiffness of 500 N/m is above 200 N/m"), std::string::npos) << last_.err;
  EXPECT_NE(last_.out.find("PHANToM Premium 3.0 class in a relaxed hand"), std::string::npos) << last_.out;
  (void)feel("simulated", {"--stiffness", "150"});
  EXPECT_EQ(last_.err.find("a stiffness of"), std::string::npos) << last_.err;
}

TEST_F(SimulatedDeviceOnThePath, RefusesWhatIsNotThere) {
  const auto refusal = [&](const std::string& option, const std::string& value) {
    const ProgramResult result =
        run({"probe", "--example", "abc", "--path", "path.csv", "--out", "no.csv", option, value});
    EXPECT_EQ(result.exit_code, 2) << value;
    EXPECT_FALSE(std::filesystem::exists(folder_.path("no.csv")));
    return result.err;
  };
  EXPECT_NE(refusal("--device", "simulated:omega").find("premium3, falcon, ideal"), std::string::npos);
  EXPECT_NE(refusal("--device", "mouse2").find("unknown device"), std::string::npos);
  EXPECT_NE(refusal("--rate", "50").find("100 to 10000"), std::string::npos);
}

}  // namespace
}  // namespace palpate::test
