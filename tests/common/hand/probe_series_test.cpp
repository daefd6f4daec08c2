// A scalar over time at the probe: linear in the tetrahedron that the probe is in, at every step, in the
// order of time. No time is asserted; every wait gives up after half a minute.
#include "common/hand/probe_series.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <functional>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/temp_folder.h"

namespace palpate::test {
namespace {

/// Corners of the one cell.
constexpr std::array<Vec3, 4> kCorners{Vec3{0.0}, Vec3{2.0, 0.0, 0.0}, Vec3{0.0, 2.0, 0.0},
                                       Vec3{0.0, 0.0, 2.0}};
constexpr int kSteps = 9;

/// Linear in space, so that there is one right answer between the corners, and not in time.
double value(const Vec3& x, double t) { return 1.0 + 3.0 * x.x - 2.0 * x.y + 0.5 * t * t * x.z + t; }

std::string one_cell(double t) {
  std::string values, points;
  for (const Vec3& x : kCorners) {
    values += std::to_string(value(x, t)) + " ";
    points += std::to_string(x.x) + " " + std::to_string(x.y) + " " + std::to_string(x.z) + " ";
  }
  const auto array = [](const std::string& type, const std::string& rest, const std::string& text) {
    return "<DataArray type=\"" + type + "\" " + rest + " format=\"ascii\">" + text + "</DataArray>";
  };
  return "<VTKFile type=\"UnstructuredGrid\" version=\"0.1\"><UnstructuredGrid><Piece NumberOfPoints=\"4\" "
         "NumberOfCells=\"1\"><PointData>" +
         array("Float64", "Name=\"vm\"", values) + "</PointData><Points>" +
         array("Float64", "Name=\"x\" NumberOfComponents=\"3\"", points) + "</Points><Cells>" +
         array("Int64", "Name=\"connectivity\"", "0 1 2 3") + array("Int64", "Name=\"offsets\"", "4") +
         array("UInt8", "Name=\"types\"", "10") + "</Cells></Piece></UnstructuredGrid></VTKFile>";
}

class ProbeSeriesTest : public ::testing::Test {
 protected:
  /// Steps that stand in another order than that of their times.
  ProbeSeriesTest() {
    std::string steps;
    for (int i = 0; i < kSteps; ++i) {
      const int t = (4 * i) % kSteps;
      const std::string name = "step" + std::to_string(t) + ".vtu";
      (void)folder_.write(name, one_cell(t));
      steps += "<DataSet timestep=\"" + std::to_string(t) + "\" file=\"" + name + "\"/>";
    }
    input_.files = {folder_.write("wall.pvd",
                                  "<?xml version=\"1.0\"?><VTKFile type=\"Collection\" "
                                  "version=\"0.1\"><Collection>" +
                                      steps + "</Collection></VTKFile>")};
    input_.kind = FieldKind::kScalar;
  }

  static bool wait_for(const std::function<bool()>& happened) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(30);
    while (!happened()) {
      if (std::chrono::steady_clock::now() > end) return false;
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    return true;
  }
  bool complete(const Vec3& place) {
    return wait_for([&] {
      const SeriesCurve curve = series_.curve();
      return curve.read == kSteps && curve.place && glm::distance(*curve.place, place) < 1e-12;
    });
  }
  void expect_exact(const Vec3& place) {
    const SeriesCurve curve = series_.curve();
    ASSERT_EQ(curve.times.size(), kSteps);
    for (int t = 0; t < kSteps; ++t) {
      EXPECT_EQ(curve.times[static_cast<std::size_t>(t)], t);
      EXPECT_NEAR(curve.values[static_cast<std::size_t>(t)], value(place, t), 1e-12) << t;
    }
  }

  TempFolder folder_;
  InputOptions input_;
  ProbeSeries series_{[] {}};
};

TEST_F(ProbeSeriesTest, IsTheLinearInterpolantAtEveryStepInTheOrderOfTime) {
  const Vec3 first{0.25, 0.5, 0.75}, second{1.0, 0.125, 0.25};
  series_.request(first);
  EXPECT_FALSE(series_.reading()) << "nothing is chosen";
  series_.choose(input_, "vm", 1);
  ASSERT_TRUE(complete(first));
  expect_exact(first);
  for (const bool keep : {true, false}) {  // whether steps are read anew or not is not seen
    series_.keep_steps(keep);
    series_.request(second);
    ASSERT_TRUE(complete(second));
    expect_exact(second);
    series_.request(first);
    ASSERT_TRUE(complete(first));
    expect_exact(first);
  }
  EXPECT_TRUE(wait_for([&] { return !series_.reading(); }));
}

TEST_F(ProbeSeriesTest, HasNoValueOutsideAndSaysWhatIsWrong) {
  const Vec3 outside{5.0, 5.0, 5.0};
  series_.choose(input_, "vm", 1);
  series_.request(outside);
  ASSERT_TRUE(complete(outside));
  for (const double v : series_.curve().values) EXPECT_TRUE(std::isnan(v));
  // Once the size of the data is known, what trembles by less than a thousandth of it is at rest.
  series_.request(outside + Vec3{1e-6, 0.0, 0.0});
  EXPECT_FALSE(series_.reading());
  series_.choose(input_, "no", 1);
  ASSERT_TRUE(wait_for([&] { return !series_.curve().problem.empty(); }));
  EXPECT_NE(series_.curve().problem.find("vm"), std::string::npos) << "the known ones are named";
  series_.choose(input_, "", 1);
  EXPECT_TRUE(wait_for([&] { return series_.curve().name.empty() && !series_.reading(); }));
}

TEST(CoarseToFine, TakesEachOnceAndEndsFirst) {
  EXPECT_TRUE(coarse_to_fine(0).empty());
  for (const std::size_t count : {1U, 2U, 3U, 8U, 81U, 100U}) {
    const std::vector<std::size_t> order = coarse_to_fine(count);
    EXPECT_EQ(std::set<std::size_t>(order.begin(), order.end()).size(), count);
    EXPECT_EQ(order.size(), count);
    EXPECT_EQ(order[0], 0U);
    EXPECT_EQ(order[count > 1 ? 1 : 0], count - 1);
  }
  // A quarter of the steps leaves no gap of more than twice what they would have evenly.
  std::vector<std::size_t> quarter = coarse_to_fine(100);
  quarter.resize(25);
  std::sort(quarter.begin(), quarter.end());
  for (std::size_t i = 1; i < quarter.size(); ++i) EXPECT_LE(quarter[i] - quarter[i - 1], 8U);
}

}  // namespace
}  // namespace palpate::test
