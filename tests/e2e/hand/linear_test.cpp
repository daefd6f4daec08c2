// The mode `linear` of flow and grid, run as a user runs it.

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "common/field/analytic/examples.h"
#include "common/field/vector_field.h"
#include "common/haptics/workspace.h"
#include "tests/e2e/explorer_test.h"
#include "tests/e2e/hand/probe_log.h"

namespace palpate::test {
namespace {

constexpr double kStep = 0.001;       // [s]
constexpr double kStiffness = 200.0;  // [N/m] by default
constexpr double kCap = 4.0;          // [N] by default

/// A straight path.
std::vector<PathRow> stroke(const Vec3& from, const Vec3& to, int rows) {
  std::vector<PathRow> path;
  for (int i = 0; i < rows; ++i) path.push_back({kStep * i, glm::mix(from, to, i / (rows - 1.0))});
  return path;
}

class LinearMode : public ExplorerTest {
 protected:
  explicit LinearMode(const std::string& program = "flow") : ExplorerTest(program) {}

  std::vector<std::string> command(const std::string& name, const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"probe", "--example", name,     "--path", "path.csv",
                                       "--out", "log.csv",   "--mode", "linear", "--force"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  }

  ProbeLogText feel(const std::string& name, const std::vector<PathRow>& path,
                    const std::vector<std::string>& more) {
    folder_.write("path.csv", path_table(path));
    const ProgramResult result = run(command(name, more));
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return read_probe_log(folder_.path("log.csv"));
  }

  void expect_refused(const std::string& name, const std::vector<std::string>& more) {
    folder_.write("path.csv", "t,x,y,z\n0,0,0,0\n");
    const ProgramResult result = run(command(name, more));
    EXPECT_EQ(result.exit_code, 2) << more.front() << ' ' << more.back();
    EXPECT_NE(result.err.find(more.front().substr(2)), std::string::npos) << result.err;
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    EXPECT_EQ(files(), std::vector<std::string>{"path.csv"}) << "nothing half written";
  }
};

class LinearModeOfGrid : public LinearMode {
 protected:
  LinearModeOfGrid() : LinearMode("grid") {}
};

TEST_F(LinearMode, EachAxisKeepsItsRule) {
  const auto field = make_vector_field(example("saddle"));
  const double scale = Workspace::default_scale(field->diagonal());
  const Vec3 start = field->bounds().center();
  const Vec3 reach = Vec3{0.008, 0.030, 0.030} / scale;
  const auto log = feel("saddle", stroke(start, start + reach, 400),
                        {"--reference", "axes", "--axis-rules", "fixed,free,drag", "--tau", "3"});
  ASSERT_EQ(log.rows.size(), 400U);
  const double tau = 0.003 / scale;
  for (std::size_t i = 0; i < log.rows.size(); ++i) {
    const LogRow& row = log.rows[i];
    ASSERT_NEAR(row.proxy.x, start.x, 1e-12);
    ASSERT_NEAR(row.proxy.y, row.probe.y, 1e-12);
    ASSERT_NEAR(row.proxy.z, std::max(start.z, row.probe.z - tau), 1e-9) << i;
    if (i == 0) continue;  // the first step has no force
    const Vec3 force = kStiffness * scale * (row.proxy - row.probe);
    ASSERT_LT(glm::length(force), kCap);
    ASSERT_LT(glm::distance(row.force, force), 1e-6) << i;
    ASSERT_EQ(row.state, "held");
  }
}

TEST_F(LinearMode, StiffnessFollowsItsCurve) {
  const auto field = make_vector_field(example("saddle"));
  const double scale = Workspace::default_scale(field->diagonal());
  const Vec3 start = field->bounds().center();
  const auto path = stroke(start, start + 0.3 * field->bounds().size(), 600);
  const double fast = field->max_speed();
  const std::string curve = "0:0.2," + std::to_string(0.5 * fast) + ":1";
  const auto log =
      feel("saddle", path,
           {"--reference", "axes", "--axis-rules", "drag,drag,drag", "--kappa", curve, "--measure", "speed"});
  CellHint hint;
  double least = 1.0, most = 0.0;
  for (std::size_t i = 50; i < log.rows.size(); ++i) {
    const LogRow& row = log.rows[i];
    const double speed = glm::length(field->sample(row.proxy, hint).value);
    const double kappa = 0.2 + 0.8 * std::min(1.0, speed / (0.5 * fast));
    least = std::min(least, kappa);
    most = std::max(most, kappa);
    const Vec3 force = kappa * kStiffness * scale * (row.proxy - row.probe);
    ASSERT_LT(glm::distance(row.force, force), 1e-5) << i;
    ASSERT_GT(glm::length(force), 0.1);
  }
  EXPECT_LT(least, 0.4);
  EXPECT_GT(most, 0.7);
}

TEST_F(LinearMode, LeadsAlongTheFlow) {
  const auto field = make_vector_field(example("abc"));
  const auto log = feel("abc", stroke({1.0, 1.0, 1.0}, {4.0, 3.0, 4.5}, 1500), {});
  CellHint hint;
  for (const LogRow& row : log.rows) {
    const Vec3 v = field->sample(row.proxy, hint).value;
    if (row.state != "held") continue;
    ASSERT_LT(std::abs(glm::dot(row.probe - row.proxy, glm::normalize(v))), 1e-6);
  }
  EXPECT_GT(
      std::count_if(log.rows.begin(), log.rows.end(), [](const LogRow& row) { return row.state == "held"; }),
      1400);
}

TEST_F(LinearMode, TheSummarySaysWhatWasFelt) {
  folder_.write("path.csv", path_table(stroke({1.0, 1.0, 1.0}, {1.5, 1.0, 1.0}, 50)));
  const Json summary = json({"probe", "--example", "abc", "--path", "path.csv", "--mode", "linear",
                             "--reference", "curvature", "--axis-rules", "unilateral,drag,snap", "--tau",
                             "1/2/3", "--kappa", "0:0.5,1:1,smooth", "--friction", "0.25"});
  const Json expected{{"reference", "curvature"}, {"axis-rules", "unilateral,drag,snap"},
                      {"tau", "1/2/3"},           {"kappa", "0:0.5,1:1,smooth"},
                      {"measure", "value"},       {"friction", "0.25"}};
  EXPECT_EQ(summary["linear"], expected);
}

TEST_F(LinearMode, RefusesBadConstants) {
  expect_refused("abc", {"--reference", "sideways"});
  expect_refused("abc", {"--axis-rules", "free,drag"});
  expect_refused("abc", {"--axis-rules", "free,drag,sticky"});
  expect_refused("abc", {"--tau", "-1"});
  expect_refused("abc", {"--tau", "1:2,1:3"});
  expect_refused("abc", {"--kappa", "2"});
  expect_refused("abc", {"--kappa", "0:nan"});
  expect_refused("abc", {"--friction", "-1"});
  expect_refused("abc", {"--stiffness", "-200"});
  expect_refused("abc", {"--stiffness", "nan"});
  expect_refused("abc", {"--rate", "0"});
}

TEST_F(LinearModeOfGrid, HoldsAgainstTheGradient) {
  // Rings about the z axis, so that the gradient has no part around it.
  const auto log = feel("marschner-lobb", stroke({0.1, 0.1, 0.0}, {0.7, 0.5, 0.05}, 800),
                        {"--axis-rules", "drag,free,free", "--tau", "5"});
  double largest = 0.0;
  for (const LogRow& row : log.rows) {
    const Vec3 around = glm::normalize(Vec3{-row.proxy.y, row.proxy.x, 0.0});
    largest = std::max(largest, glm::length(row.force));
    EXPECT_LT(std::abs(glm::dot(row.force, around)), 0.05 + 0.15 * glm::length(row.force));
  }
  EXPECT_GT(largest, 0.5);
}

/// Drag along the gradient whose stiffness grows with the gradient: borders are felt as shells, stiff where
/// they are steep, and what lies between them is soft.
TEST_F(LinearModeOfGrid, FeelsSteepBordersAsStiffShells) {
  // The built-in volume: A exp(-((r - R) / w)^2) for each shell, on 255 steps.
  constexpr double kShells[4][2] = {{0.2, 1.0}, {0.42, 0.75}, {0.64, 0.5}, {0.86, 0.25}}, kWidth = 0.05;
  const auto value = [&](double r) {
    double sum = 0.0;
    for (const auto& [radius, height] : kShells) {
      const double away = (r - radius) / kWidth;
      sum += height * std::exp(-away * away);
    }
    return 255.0 * sum;
  };
  constexpr double kSteep = 2500.0, kSoft = 0.05;
  const Vec3 along = glm::normalize(Vec3(1.0, 0.3, 0.2));
  const auto log = feel(
      "shells", stroke(along, 0.1 * along, 4000),
      {"--axis-rules", "drag,free,free", "--tau", "2", "--measure", "gradient", "--kappa", "0:0.05,2500:1"});
  const double scale = Workspace::default_scale(std::sqrt(12.0));
  double softest = 1.0, stiffest = 0.0;
  for (std::size_t i = 200; i < log.rows.size(); ++i) {
    const LogRow& row = log.rows[i];
    const double r = glm::length(row.proxy), stretch = scale * glm::distance(row.proxy, row.probe);
    // Differences over a voxel to either side, as the measure takes them.
    constexpr double kVoxel = 2.0 / 95.0;
    const double gradient = std::abs(value(r + kVoxel) - value(r - kVoxel)) / (2.0 * kVoxel);
    if (stretch < 1.5e-3) continue;  // where the gradient turns over, the drag has to set in again
    const double kappa = glm::length(row.force) / (kStiffness * stretch);
    const double expected = kSoft + (1.0 - kSoft) * std::min(1.0, gradient / kSteep);
    ASSERT_NEAR(kappa, expected, 0.12) << "at r = " << r;
    softest = std::min(softest, kappa);
    stiffest = std::max(stiffest, kappa);
  }
  EXPECT_LT(softest, 0.1);
  EXPECT_GT(stiffest, 0.9);
}

TEST_F(LinearModeOfGrid, OffersNoFlow) {
  expect_refused("blob", {"--reference", "flow"});
  expect_refused("blob", {"--measure", "speed"});
}

}  // namespace
}  // namespace palpate::test
