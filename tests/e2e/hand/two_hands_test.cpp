// Tracked hands at an immersive workbench, as `grid probe --workbench` follows a recording of them: the
// stylus probes, the other hand carries the cutting plane.

#include <cmath>
#include <cstdio>
#include <regex>
#include <string>
#include <vector>

#include "common/math/quaternion.h"
#include "tests/e2e/explorer_test.h"
#include "tests/support/shared_data.h"

namespace palpate::test {
namespace {

const Quat kTurn{0.6, 0.8, 0.0, 0.0};  // of the tracker's axes
const Vec3 kMiddle{0.3, 0.2, 0.1};     // [m] of the workbench
const Vec3 kTip{0.0, 0.0, -0.12};
constexpr double kGain = 1.5;
const char* const kBench =
    "[stylus]\ntip = [0, 0, -0.12]\n\n[interaction]\ntechnique = \"immersive\"\nmiddle = [0.3, 0.2, 0.1]\n"
    "rotation = [0.6, 0.8, 0, 0]\ngain = 1.5\n";

/// The turn that takes z to the unit vector n. @pre n is not -z.
Quat to_normal(const Vec3& n) {
  const Vec3 axis = glm::cross(Vec3(0.0, 0.0, 1.0), n);
  return glm::normalize(Quat{1.0 + n.z, axis.x, axis.y, axis.z});
}

class TwoHands : public ExplorerTest {
 protected:
  TwoHands() : ExplorerTest("grid") {}

  /// A recording in which the other hand takes the plane through the middle of the data, turns it by `turn`
  /// and moves it by `way` [data units], and lets go, while the stylus rests on where it was.
  static std::string recording(const Quat& turn, const Vec3& way, double diagonal) {
    const double metres = 0.25 / diagonal / kGain;  // of the hand, a data unit
    const Quat back = glm::conjugate(kTurn);
    const Vec3 stylus = kMiddle + back * Vec3(0.045 / kGain, 0.0, 0.001 / kGain) - kTip;
    std::string table = "t,x,y,z,qw,qx,qy,qz,b0,hx,hy,hz,hqw,hqx,hqy,hqz,h0\n";
    constexpr int kRows = 600;
    for (int i = 0; i <= kRows; ++i) {
      // A third before it takes hold, a third with it, a third after.
      const double part = std::clamp(3.0 * i / kRows - 1.0, 0.0, 1.0);
      const Quat part_turn = glm::slerp(identity_rotation(), turn, part);
      const Quat q = glm::normalize(back * part_turn * kTurn);
      const Vec3 p = kMiddle + back * (metres * part * way);
      char line[512];
      std::snprintf(line, sizeof line,
                    "%.17g,%.17g,%.17g,%.17g,1,0,0,0,0,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%d\n",
                    1e-3 * i, stylus.x, stylus.y, stylus.z, p.x, p.y, p.z, q.w, q.x, q.y, q.z,
                    i > kRows / 4 && i < 3 * kRows / 4 ? 1 : 0);
      table += line;
    }
    return table;
  }

  [[nodiscard]] std::string log_without_times() const {
    // What a step took, the thirteenth column, is no matter of the data.
    static const std::regex kTime("(^|\n)((?:[^,\n]*,){12})[^,\n]*");
    return std::regex_replace(read_file(folder_.path("log.csv")), kTime, "$1$2");
  }
};

TEST_F(TwoHands, CarryAPlaneAndReplayToTheBit) {
  folder_.write("workbench.toml", kBench);
  const Vec3 n = glm::normalize(Vec3(0.3, -0.2, 0.9)), way{0.02, 0.05, -0.1};
  const Json info = json({"info", "--example", "shells"});
  folder_.write("hands.csv", recording(to_normal(n), way, std::sqrt(12.0)));
  const std::vector<std::string> command{"probe",        "--example",   "shells",         "--path",
                                         "hands.csv",    "--workbench", "workbench.toml", "--mode",
                                         "plane-widget", "--out",       "log.csv",        "--force"};
  const Json summary = json(command);
  ASSERT_EQ(summary["planes"].size(), 1U) << info;
  const Json& plane = summary["planes"][0];
  for (std::size_t a = 0; a < 3; ++a)
    EXPECT_NEAR(plane["normal"][a].get<double>(), n[static_cast<int>(a)], 1e-12);
  EXPECT_NEAR(plane["d"].get<double>(), glm::dot(n, way), 1e-12);
  EXPECT_EQ(summary["faults"], 0);
  EXPECT_GT(summary["max_force_n"].get<double>(), 0.05) << "the stylus was on the plane";
  const std::string first = log_without_times();
  (void)json(command);
  EXPECT_EQ(log_without_times(), first);
}

TEST_F(TwoHands, PlaceAPlaneThroughThreePointsOfTheTooth) {
  PALPATE_NEED_DATA(tooth, "grid/tooth/tooth.nhdr");
  const Vec3 points[]{{30.0, 40.0, 120.0}, {70.0, 35.0, 110.0}, {50.0, 70.0, 60.0}};
  const Vec3 n = glm::normalize(glm::cross(points[1] - points[0], points[2] - points[0]));
  const Vec3 center{51.0, 46.5, 80.0};
  folder_.write("workbench.toml", kBench);
  folder_.write("hands.csv", recording(to_normal(n), glm::dot(n, points[0] - center) * n,
                                       glm::length(Vec3(102.0, 93.0, 160.0))));
  const Json summary = json({"probe", tooth.string(), "--path", "hands.csv", "--workbench", "workbench.toml",
                             "--mode", "plane-widget"});
  const Json& plane = summary["planes"][0];
  const Vec3 normal{plane["normal"][0], plane["normal"][1], plane["normal"][2]};
  for (const Vec3& each : points) {
    // A voxel is one unit here.
    EXPECT_LT(std::abs(glm::dot(normal, each) - plane["d"].get<double>()), 0.01);
  }
}

TEST_F(TwoHands, SaysWhatDoesNotFit) {
  folder_.write("workbench.toml", kBench);
  folder_.write("desk.toml", "[interaction]\ntechnique = \"desktop\"\n");
  folder_.write("wrong.toml", "[interaction]\n\ntechnique = \"gloves\"\n");
  folder_.write("path.csv", "t,x,y,z\n0,0,0,0\n0.001,0,0,0\n");
  const auto probe = [this](const char* workbench) {
    return run({"probe", "--example", "shells", "--path", "path.csv", "--json", "--workbench", workbench});
  };
  EXPECT_EQ(probe("desk.toml").exit_code, 0) << "a path is a desktop's";
  const ProgramResult path = probe("workbench.toml");
  EXPECT_EQ(path.exit_code, 3);
  EXPECT_NE(path.err.find("qw"), std::string::npos) << path.err;
  const ProgramResult wrong = probe("wrong.toml");
  EXPECT_EQ(wrong.exit_code, 3);
  EXPECT_NE(wrong.err.find("line 3"), std::string::npos) << wrong.err;
  EXPECT_EQ(probe("none.toml").exit_code, 3);
  const ProgramResult arm = run({"probe", "--example", "shells", "--path", "path.csv", "--json",
                                 "--workbench", "workbench.toml", "--device", "simulated"});
  EXPECT_EQ(arm.exit_code, 2) << arm.err;
  // In the window hands need such a workbench; that of hands is a desktop's without them, but for a display.
  const ProgramResult desk = run({"open", "--example", "shells", "--workbench", "workbench.toml"});
  EXPECT_EQ(desk.exit_code, 1);
  EXPECT_NE(desk.err.find("this is a desktop"), std::string::npos) << desk.err;
  EXPECT_EQ(run({"open", "--example", "shells", "--device", "hands:path.csv"}).exit_code, 2);
}

}  // namespace
}  // namespace palpate::test
