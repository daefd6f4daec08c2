// The force-field modes of `flow probe`, run as a user runs them.

#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "common/field/analytic/examples.h"
#include "common/field/vector_field.h"
#include "common/haptics/workspace.h"
#include "tests/e2e/explorer_test.h"
#include "tests/e2e/hand/probe_log.h"

namespace palpate::test {
namespace {

constexpr double kStep = 0.001;  // [s]

class ForceFieldModes : public ExplorerTest {
 protected:
  ForceFieldModes() : ExplorerTest("flow") {}

  ProbeLogText feel(const std::string& mode, const std::string& name, const std::vector<PathRow>& path,
                    const std::vector<std::string>& more = {}) {
    folder_.write("path.csv", path_table(path));
    std::vector<std::string> arguments{"probe", "--example", name,     "--path", "path.csv",
                                       "--out", "log.csv",   "--mode", mode,     "--force"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const ProgramResult result = run(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return read_probe_log(folder_.path("log.csv"));
  }

  /// Three times round an ellipse in data coordinates, once in two seconds.
  static std::vector<PathRow> round(const Vec3& center, const Vec3& a, const Vec3& b) {
    std::vector<PathRow> rows;
    for (int i = 0; i < 6000; ++i) {
      const double angle = std::numbers::pi * kStep * i;
      rows.push_back({kStep * i, center + std::cos(angle) * a + std::sin(angle) * b});
    }
    return rows;
  }
};

TEST_F(ForceFieldModes, DirectDisplayIsTheFlowAtTheProbe) {
  const auto field = make_vector_field(example("abc"));
  const auto log = feel("direct", "abc", round({3.0, 3.0, 3.0}, {1.5, 0.0, 0.5}, {0.0, 1.0, -1.0}),
                        {"--field-force", "2"});
  ASSERT_EQ(log.rows.size(), 6000U);
  CellHint hint;
  for (std::size_t i = 100; i < log.rows.size(); ++i) {
    const LogRow& row = log.rows[i];
    ASSERT_EQ(row.proxy, row.probe);
    ASSERT_EQ(row.state, "held");
    const Vec3 expected = 2.0 * field->sample(row.probe, hint).value / field->max_speed();
    ASSERT_LT(glm::distance(row.force, expected), 1e-9) << i;
  }
}

TEST_F(ForceFieldModes, DragsOpposeTheHandAndTakeEnergyAllTheWayRound) {
  const auto field = make_vector_field(example("tornado"));
  const double scale = Workspace::default_scale(field->diagonal());
  const Vec3 center = field->bounds().center(), reach = 0.3 * field->bounds().size();
  for (const std::string mode : {"transverse", "density"}) {
    const auto log = feel(mode, "tornado", round(center, {reach.x, 0.0, 0.2 * reach.z}, {0.0, reach.y, 0.0}));
    double work = 0.0, largest = 0.0;  // [J] of the last two rounds
    for (std::size_t i = 2001; i < log.rows.size(); ++i) {
      const Vec3 moved = scale * (log.rows[i].probe - log.rows[i - 1].probe);
      work += glm::dot(log.rows[i - 1].force, moved);
      // The velocity is an estimate over some steps, in which a round hand turns by a few thousandths.
      ASSERT_LE(glm::dot(log.rows[i].force, moved),
                0.05 * glm::length(log.rows[i].force) * glm::length(moved))
          << mode << ' ' << i;
      largest = std::max(largest, glm::length(log.rows[i].force));
    }
    EXPECT_LT(work, -1e-3) << mode;
    EXPECT_GT(largest, 0.05) << mode;
    // At rest nothing is felt.
    const auto rest = feel(mode, "tornado", {{0.0, center}, {0.1, center}, {0.2, center}});
    EXPECT_EQ(rest.rows.back().force, Vec3(0.0)) << mode;
  }
}

TEST_F(ForceFieldModes, AVortexPullsToItsCore) {
  // Round Hill's vortex ring, whose core lies at r = 1 / sqrt 2 in the plane z = 0: inside of it the pull is
  // outwards, outside inwards, and nowhere along.
  std::vector<PathRow> rows;
  for (int i = 0; i < 600; ++i) {
    const double r = i < 300 ? 0.55 : 0.85, angle = 0.01 * i;
    rows.push_back({kStep * i, {r * std::cos(angle), r * std::sin(angle), 0.0}});
  }
  const auto log = feel("vortex", "hill", rows);
  for (const std::size_t i : {290U, 590U}) {
    const LogRow& row = log.rows[i];
    const Vec3 outwards = glm::normalize(row.probe);
    EXPECT_EQ(glm::dot(row.force, outwards) > 0.0, i < 300) << i;
    EXPECT_GT(glm::length(row.force), 0.01) << i;
    EXPECT_LT(glm::length(row.force - glm::dot(row.force, outwards) * outwards),
              0.02 * glm::length(row.force));
  }
}

TEST_F(ForceFieldModes, AreAmongTheModesThatAnUnknownWordLists) {
  folder_.write("path.csv", "t,x,y,z\n0,1,1,1\n");
  const ProgramResult result =
      run({"probe", "--example", "abc", "--path", "path.csv", "--out", "log.csv", "--mode", "push"});
  EXPECT_EQ(result.exit_code, 2);
  for (const char* known : {"direct", "transverse", "vortex", "density"}) {
    EXPECT_NE(result.err.find(known), std::string::npos) << result.err;
  }
}

}  // namespace
}  // namespace palpate::test
