// `flow probe --device simulated`, run as a user runs it: a hand that wants to be on the path.

#include <cmath>
#include <string>
#include <vector>

#include "common/field/analytic/examples.h"
#include "common/field/vector_field.h"
#include "common/haptics/workspace.h"
#include "tests/e2e/explorer_test.h"
#include "tests/e2e/probe_log.h"

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
