// A menu in space under a recorded stylus, from the command line: what is pointed at, chosen, set and picked.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "common/math/quaternion.h"
#include "common/math/vec.h"
#include "tests/e2e/explorer_test.h"

namespace palpate::test {
namespace {

constexpr double kEntry = 0.02;
const Vec3 kCorner{0.1, 0.2, 0.3};

class Controls : public ExplorerTest {
 protected:
  Controls() : ExplorerTest("workbench") {
    folder_.write(
        "workbench.toml",
        "[stylus]\ntip = [0, 0, -0.1]\n[interaction]\nmiddle = [0.1, 0.2, 0.3]\ntechnique = 'immersive'\n");
  }

  /// A row in which the stylus points from where it is at `at`.
  void point_at(const Vec3& at, bool button) {
    const Vec3 sensor = kCorner + Vec3(0.05, -0.05, 0.5), along = glm::normalize(at - sensor);
    // The turn that takes -z to it.
    const Vec3 axis = glm::cross(Vec3(0.0, 0.0, -1.0), along);
    const Quat q = glm::normalize(Quat{1.0 - along.z, axis.x, axis.y, axis.z});
    char row[256];
    std::snprintf(row, sizeof row, "%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%d\n", 0.01 * rows_++,
                  sensor.x, sensor.y, sensor.z, q.w, q.x, q.y, q.z, button ? 1 : 0);
    table_ += row;
  }
  void point(double u, double v, bool button) { point_at(kCorner + kEntry * Vec3(u, -v, 0.0), button); }

  std::string table_ = "t,x,y,z,qw,qx,qy,qz,b0\n";
  int rows_ = 0;
};

TEST_F(Controls, AreWorkedByARecordedStylus) {
  point(1.0, 0.5, false);  // opens "Mode"
  point(8.5, 1.5, false);  // "isosurface", in the second column
  point(8.5, 1.5, true);
  point(8.5, 1.5, false);
  point(1.0, 3.05, false);  // the slider "Opacity", from 0.5
  point(3.5, 3.05, true);
  for (double u = 3.5; u < 5.3; u += 0.02) point(u, 3.05, true);
  point(5.3, 3.05, false);
  const double top = 5.0;  // of the knob
  for (int degrees = 0; degrees <= 47; ++degrees) {
    const double a = degrees * kDegree;
    point(1.5 + 0.7 * std::cos(a), top + 1.5 + 0.7 * std::sin(a), degrees > 0);
  }
  point_at(kCorner + Vec3(0.24, -0.09, -0.05), false);  // the second ball
  folder_.write("hands.csv", table_);
  const Json told = json({"controls", "hands.csv", "--workbench", "workbench.toml", "--out", "log.csv",
                          "--picture", "menu.png"});
  EXPECT_EQ(told["events"][0]["label"], "isosurface");
  EXPECT_EQ(told["events"][0]["id"], 12);
  EXPECT_NEAR(told["opacity"].get<double>(), 0.8, 1e-12);
  EXPECT_EQ(told["turn"], 45.0);
  EXPECT_EQ(told["events"].size(), 1U + 3U + 3U) << "three detents each";
  const std::string log = read_file(folder_.path("log.csv"));
  EXPECT_EQ(std::count(log.begin(), log.end(), '\n'), rows_ + 1);
  EXPECT_NE(log.find(",isosurface,chosen,12,,"), std::string::npos);
  EXPECT_EQ(log.substr(log.size() - 5), ",2,2\n") << "picked by the ray and through the aperture";
  EXPECT_EQ(run({"controls", "hands.csv", "--out", "log.csv"}).exit_code, 2) << "it is there already";
  EXPECT_EQ(run({"controls", "none.csv"}).exit_code, 3);
  EXPECT_EQ(run({"controls"}).exit_code, 2);
}

}  // namespace
}  // namespace palpate::test
