// Haptic grid and cutting planes by hand, as `grid probe` does them on a recorded path.

#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "common/math/vec.h"
#include "tests/e2e/explorer_test.h"
#include "tests/support/shared_data.h"

namespace palpate::test {
namespace {

/// A hand that is led, as a table for `--path`.
class Hand {
 public:
  explicit Hand(const Vec3& start) : at_(start) { add(false); }
  void lead(const Vec3& to, bool down) {
    const Vec3 from = at_;
    constexpr int kSteps = 200;
    for (int i = 1; i <= kSteps; ++i) {
      at_ = glm::mix(from, to, static_cast<double>(i) / kSteps);
      add(down);
    }
  }
  [[nodiscard]] const std::string& table() const { return table_; }

 private:
  void add(bool down) {
    char line[128];
    std::snprintf(line, sizeof line, "%.17g,%.17g,%.17g,%.17g,%d\n", 1e-3 * step_++, at_.x, at_.y, at_.z,
                  down ? 1 : 0);
    table_ += line;
  }

  Vec3 at_;
  int step_ = 0;
  std::string table_ = "t,x,y,z,b0\n";
};

class GridWidget : public ExplorerTest {
 protected:
  GridWidget() : ExplorerTest("grid") {}

  /// Texts of a column of the log, in order.
  std::vector<std::string> column(const std::string& file, std::size_t number) {
    std::istringstream text(read_file(folder_.path(file)));
    std::vector<std::string> cells;
    std::string line;
    std::getline(text, line);
    while (std::getline(text, line)) {
      std::istringstream words(line);
      std::string cell;
      for (std::size_t i = 0; i <= number; ++i) std::getline(words, cell, ',');
      cells.push_back(cell);
    }
    return cells;
  }
};

TEST_F(GridWidget, PlacesAPlaneThroughThreePointsOfTheTooth) {
  PALPATE_NEED_DATA(tooth, "grid/tooth/tooth.nhdr");
  const Vec3 points[]{{30.0, 40.0, 120.0}, {70.0, 35.0, 110.0}, {50.0, 70.0, 60.0}};
  const Vec3 n = glm::normalize(glm::cross(points[1] - points[0], points[2] - points[0]));
  const Vec3 up{0.0, 0.0, 1.0}, center{51.0, 46.5, 80.0};  // of the plane to begin with
  const double scale = 0.25 / glm::length(Vec3(102.0, 93.0, 160.0)), radius = 0.025 / scale;

  // Hold of the sphere off its circles, turned as z has to be to become n.
  const Vec3 across = glm::normalize(n - n.z * up);
  const auto on_sphere = [&](double angle) {
    return center + radius * (std::cos(angle) * across + std::sin(angle) * up);
  };
  Hand hand(center + 3.0 * radius * up);
  hand.lead(on_sphere(0.8), false);
  for (int i = 0; i <= 20; ++i) hand.lead(on_sphere(0.8 - std::acos(n.z) * i / 20.0), true);
  // Hold of the plane beside the sphere, pulled over along n.
  const Vec3 beside = center + 1.5 * radius * glm::normalize(glm::cross(n, Vec3(1.0, 0.2, 0.1)));
  hand.lead(center + 3.0 * radius * n, false);
  hand.lead(beside + 2.0 * radius * n, false);
  hand.lead(beside, false);
  hand.lead(beside, true);
  hand.lead(beside + glm::dot(n, points[0] - center) * n, true);
  hand.lead(beside + 3.0 * radius * n, false);
  folder_.write("path.csv", hand.table());

  const Json summary = json({"probe", tooth.string(), "--path", "path.csv", "--mode", "plane-widget", "--out",
                             "log.csv", "--detent", "0", "--plane-reach", "3"});
  ASSERT_EQ(summary["planes"].size(), 1U);
  const Json& plane = summary["planes"][0];
  const Vec3 normal{plane["normal"][0], plane["normal"][1], plane["normal"][2]};
  for (const Vec3& each : points) {
    // A voxel is one unit here.
    EXPECT_LT(std::abs(glm::dot(normal, each) - plane["d"].get<double>()), 0.01);
  }
  EXPECT_EQ(summary["faults"], 0);

  // What the hand has found, typed in.
  const Json typed = json({"probe", tooth.string(), "--path", "path.csv", "--mode", "plane-widget",
                           "--planes", "through:30,40,120,70,35,110,50,70,60", "--plane-reach", "1e-9"});
  const Json& same = typed["planes"][0];
  for (int a = 0; a < 3; ++a)
    EXPECT_NEAR(same["normal"][static_cast<std::size_t>(a)].get<double>(), normal[a], 1e-9);
}

TEST_F(GridWidget, LeadsAlongOneAxisWithTheOthersUntouched) {
  Hand hand({-0.5, 0.1, 0.1});
  hand.lead({0.5, 0.12, 0.08}, false);
  folder_.write("path.csv", hand.table());
  const Json summary = json({"probe", "--example", "shells", "--path", "path.csv", "--out", "log.csv"});
  EXPECT_EQ(summary["mode"], "grid") << "the default";
  EXPECT_EQ(summary["grid"]["grid-frame"], "data");
  const auto y = column("log.csv", 5), z = column("log.csv", 6), x = column("log.csv", 4);
  EXPECT_EQ(std::set<std::string>(y.begin(), y.end()).size(), 1U) << "to the last bit";
  EXPECT_EQ(std::set<std::string>(z.begin(), z.end()).size(), 1U);
  EXPECT_GT(std::set<std::string>(x.begin(), x.end()).size(), 100U);
}

/// Two domains at once: the value at the proxy, and its place among all values.
TEST_F(GridWidget, LogsTheValueAndItsPlaceInTheHistogram) {
  Hand hand({-0.99, 0.0, 0.0});
  hand.lead({0.0, 0.0, 0.0}, false);
  hand.lead({3.0, 0.0, 0.0}, false);
  folder_.write("path.csv", hand.table());
  (void)json({"probe", "--example", "shells", "--path", "path.csv", "--mode", "density", "--out", "log.csv"});
  std::istringstream log(read_file(folder_.path("log.csv")));
  std::string header;
  std::getline(log, header);
  ASSERT_TRUE(header.ends_with(",value,below")) << header;
  const auto columns = static_cast<std::size_t>(std::count(header.begin(), header.end(), ','));
  const auto x = column("log.csv", 1), values = column("log.csv", columns - 1),
             below = column("log.csv", columns);
  ASSERT_EQ(values.size(), x.size());
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double r = std::abs(std::stod(x[i]));
    if (r > 1.0) {
      EXPECT_EQ(values[i], "nan") << "outside";
      EXPECT_EQ(below[i], "nan");
      continue;
    }
    // The innermost of the shells about the middle is 255, and few voxels have as much; the gaps between
    // shells are less than most voxels.
    const double value = std::stod(values[i]), part = std::stod(below[i]);
    ASSERT_TRUE(part >= 0.0 && part <= 1.0) << part;
    if (value > 240.0) {
      EXPECT_GT(part, 0.98);
    }
    if (value < 1.0) {
      EXPECT_LT(part, 0.6);
    }
  }
}

TEST_F(GridWidget, FindsLandmarksWhereValuesPileUp) {
  Hand hand({-0.5, 0.0, 0.0});
  hand.lead({0.5, 0.0, 0.0}, false);
  folder_.write("path.csv", hand.table());
  const Json marked = json(
      {"probe", "--example", "blob", "--path", "path.csv", "--grid-peaks", "1", "--grid-marks", "x:0.25"});
  ASSERT_GE(marked["landmarks"].size(), 2U);
  EXPECT_EQ(marked["landmarks"][0], Json({1.0, 0.0, 0.0, 0.25}));
  EXPECT_EQ(marked["grid"]["grid-marks"], "x:0.25");
  // One for each axis at most, and a blob in the middle has just that.
  EXPECT_LE(marked["landmarks"].size(), 4U);
}

TEST_F(GridWidget, MeasuresAndWritesAnnotations) {
  const std::vector<std::string> marks{"annotate",
                                       "--example",
                                       "shells",
                                       "--annotation",
                                       "length:0,0,0,0.3,0.4,0=from the middle",
                                       "--annotation",
                                       "angle:1,0,0,0,0,0,0,1,0",
                                       "--annotation",
                                       "point:9,9,9"};
  std::vector<std::string> arguments = marks;
  arguments.insert(arguments.end(), {"--out", "notes.csv"});
  const Json summary = json(arguments);
  ASSERT_EQ(summary["annotations"].size(), 3U);
  EXPECT_NEAR(summary["annotations"][0]["measure"].get<double>(), 0.5, 1e-15);
  EXPECT_EQ(summary["annotations"][0]["label"], "from the middle");
  EXPECT_NEAR(summary["annotations"][1]["measure"].get<double>(), 90.0, 1e-12);
  EXPECT_EQ(summary["outside"], 1);
  EXPECT_TRUE(summary["annotations"][2]["values"][0].is_null()) << "no value outside";
  EXPECT_NE(read_file(folder_.path("notes.csv")).find("0,length,\"from the middle\",0.5,1,0.3,0.4,0"),
            std::string::npos);
  arguments = marks;
  arguments.insert(arguments.end(), {"--out", "notes.txt"});
  EXPECT_EQ(run(arguments).exit_code, 2);
  EXPECT_EQ(run({"annotate", "--example", "shells"}).exit_code, 2);
  EXPECT_EQ(run({"annotate", "--example", "shells", "--annotation", "length:1,2"}).exit_code, 2);
}

TEST_F(GridWidget, RefusesWhatMakesNoGridOrPlane) {
  folder_.write("path.csv", "t,x,y,z\n0,0,0,0\n");
  const auto refused = [this](const std::string& option, const std::string& value) {
    const ProgramResult result =
        run({"probe", "--example", "blob", "--path", "path.csv", "--json", option, value});
    EXPECT_EQ(result.exit_code, 2) << option << " " << value << " " << result.err;
    EXPECT_NE(result.err.find(option), std::string::npos) << result.err;
  };
  refused("--grid-frame", "plane:0,0,0,1");
  refused("--grid-spacing", "0");
  refused("--grid-spacing", "1,2");
  refused("--grid-marks", "w:3");
  refused("--grid-switch", "faces");
  refused("--grid-peaks", "99");
  refused("--grid-pull", "0.1");
  refused("--grid-detents", "2");
  refused("--planes", "1,2,3");
  refused("--planes", "through:0,0,0,1,1,1,2,2,2");
  refused("--detent", "-1");
  refused("--plane-sphere", "0");
}

}  // namespace
}  // namespace palpate::test
