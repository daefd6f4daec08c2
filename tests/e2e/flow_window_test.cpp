// A user of flows in time with nothing but a mouse: pathlines, streaklines and timelines by the slider of time; and from a file,
// as OpenFOAM, EnSight and programs of discontinuous Galerkin write it, to a line that the hand follows.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "apps/flow/flow_model.h"
#include "common/base/text.h"
#include "common/hand/mode/haptic_mode.h"
#include "tests/common/window/touch_window.h"
#include "tests/loaders/foam/foam_box.h"

namespace palpate::test {
namespace {

// v = (1 + t) (-y, x, 0) + 0.3 e_z, linear in space and in time, on [-1, 1] x [-1, 1] x [0, 2] until t = 1.
Vec3 velocity(double t, const Vec3& x) { return {-(1.0 + t) * x.y, (1.0 + t) * x.x, 0.3}; }
Vec3 carried(const Vec3& x, double from, double to) {
  const double a = (to - from) + 0.5 * (to * to - from * from), c = std::cos(a), s = std::sin(a);
  return {c * x.x - s * x.y, s * x.x + c * x.y, x.z + 0.3 * (to - from)};
}

class FlowWindow : public TouchWindowTest {
 protected:
  void SetUp() override {
    TouchWindowTest::SetUp();
    if (IsSkipped()) return;
    grow_to(1000);
    options_.program = "flow";
    options_.panels = flow_panels();
    options_.touch.modes = modes_of(FieldKind::kVector);
    options_.thumbnails = folder_.path("thumbnails");
    if (const char* const home = std::getenv("HOME")) home_ = home;
    ::setenv("HOME", folder_.path().c_str(), 1);
  }
  void TearDown() override {
    if (!home_.empty()) ::setenv("HOME", home_.c_str(), 1);
  }

  /// Five steps of images.
  std::filesystem::path moving_flow() {
    std::string list = "<VTKFile type=\"Collection\"><Collection>";
    for (int step = 0; step <= kSteps; ++step) {
      std::string text =
          "# vtk DataFile Version 3.0\nt\nASCII\nDATASET STRUCTURED_POINTS\nDIMENSIONS 5 5 5\nORIGIN -1 -1 0\n"
          "SPACING 0.5 0.5 0.5\nPOINT_DATA 125\nVECTORS v double\n";
      for (int p = 0; p < 125; ++p) {
        const Vec3 v = velocity(time_of(step),
                                {0.5 * (p % 5) - 1.0, 0.5 * (p / 5 % 5) - 1.0, 0.5 * (p / 25)});  // NOLINT
        text += exact_number(v.x) + " " + exact_number(v.y) + " " + exact_number(v.z) + "\n";
      }
      const std::string name = "t" + std::to_string(step) + ".vtk";
      folder_.write(name, text);
      list += "<DataSet timestep=\"" + exact_number(time_of(step)) + "\" file=\"" + name + "\"/>";
    }
    return folder_.write("turn.pvd", list + "</Collection></VTKFile>");
  }
  static double time_of(int step) { return static_cast<double>(step) / kSteps; }

  WindowResult run_flow(const std::filesystem::path& file) {
    Document document;
    if (!file.empty()) document.input.files = {file};
    document.tracing.seeds = "grid:3,3,3";
    document.tracing.direction = "forward";
    document.tracing.tolerance = 1e-8;
    document.common.threads = 1;
    FlowModel model(document, "flow");
    return run_model(model);
  }
  /// On the slider of time, which has a place a step.
  void choose_step(int step) { press("time step", 0, kLeast + (kMost - kLeast) * time_of(step)); }

  static constexpr int kSteps = 4;
  std::string home_;
};

TEST_F(FlowWindow, PathlinesBeginAtTheTimeOfTheSlider) {
  choose("lines", "pathlines");
  choose_step(2);
  const WindowResult result = run_flow(moving_flow());
  ASSERT_EQ(result.document.tracing.lines, "pathlines") << result.log;
  ASSERT_EQ(result.view.lines->size(), 27U) << result.log;
  std::size_t whole = 0;
  for (const Line& line : *result.view.lines) {
    const LinePoint &first = line.points.front(), &last = line.points.back();
    EXPECT_LE(glm::distance(last.position, carried(first.position, 0.5, 0.5 + last.time)),
              last.error + 1e-12);
    if (line.end != End::kEndOfTime) continue;
    ++whole;
    EXPECT_NEAR(last.time, 0.5, 1e-12);
  }
  EXPECT_GE(whole, 15U);
}

TEST_F(FlowWindow, StreaklinesAreSeenAtTheTimeOfTheSlider) {
  choose("lines", "streaklines");
  choose_step(3);
  const WindowResult result = run_flow(moving_flow());
  ASSERT_EQ(result.document.tracing.lines, "streaklines") << result.log;
  ASSERT_GE(result.view.lines->size(), 27U) << result.log;
  double oldest = 0.0;
  for (const Line& line : *result.view.lines) {
    for (const LinePoint& p : line.points) {
      oldest = std::max(oldest, p.time);
      // Where it was released: a seed of the grid, at thirds of the box and halfway between.
      const Vec3 seed = carried(p.position, 0.75, 0.75 - p.time);
      for (const double across : {seed.x, seed.y, seed.z - 1.0})
        EXPECT_NEAR(std::abs(std::abs(across) - 1.0 / 3.0), 1.0 / 3.0, 1e-5) << p.time;
    }
  }
  EXPECT_NEAR(oldest, 0.75, 1e-12) << "of the first release";
}

TEST_F(FlowWindow, TimelinesOfARowAreSeenAtTheTimeOfTheSlider) {
  choose("seeds", "row along x");
  choose("lines", "timelines");
  choose_step(4);
  const WindowResult result = run_flow(moving_flow());
  ASSERT_EQ(result.document.tracing.lines, "timelines") << result.log;
  ASSERT_EQ(result.view.lines->size(), 1U) << result.log;
  const Line& line = result.view.lines->front();
  ASSERT_EQ(line.points.size(), 50U);
  for (std::size_t i = 0; i < line.points.size(); ++i) {
    const Vec3 seed{-0.8 + 1.6 * static_cast<double>(i) / 49.0, 0.0, 1.0};
    EXPECT_LE(glm::distance(line.points[i].position, carried(seed, 0.0, 1.0)), line.points[i].error + 1e-12);
  }
}

// Without a row the window says what to do, and where.
TEST_F(FlowWindow, TimelinesOfAGridOfSeedsSayWhatToDo) {
  choose("lines", "timelines");
  const WindowResult result = run_flow(moving_flow());
  EXPECT_NE(result.log.find("row along x"), std::string::npos) << result.log;
}

class FromFileToLine : public FlowWindow {
 protected:
  /// From the start page: Open…, the name in the list, Open; a press on the lines, and along them by as much as leads away.
  WindowResult follow(const std::string& entry) {
    options_.start_page = true;
    options_.recent = {{{folder_.path("other.vtk")}}};  // where the dialog begins
    folder_.write("other.vtk", "x");
    press("Open…");
    press(entry);
    press("Open");
    last_ += 2 * kPause;
    press("Grab");
    const int grab = next();
    move_by(grab, 0.0, 0.0);
    at(grab + 2, {.kind = InputKind::kPress});
    last_ += kPause;
    lead_to(40.0, -30.0);
    last_ += kPause;
    key('K');
    at(next(), {.kind = InputKind::kRelease});
    last_ += kPause;
    press("Save lines");
    last_ += kPause;
    const WindowResult result = run_flow({});
    EXPECT_TRUE(result.shown) << result.log;
    EXPECT_GT(result.view.lines->size(), 0U);
    expect_kept_helix(result);  // which was held: the hand has let go of it since, to save it
    return result;
  }
  /// One line is kept and saved: of u = (-y, x, 0.3), along which the distance from the axis and phi - z / 0.3 stay.
  void expect_kept_helix(const WindowResult& result) const {
    EXPECT_NE(result.log.find("kept line 1"), std::string::npos) << result.log;
    EXPECT_TRUE(std::filesystem::exists(folder_.path("followed.vtp"))) << result.log;
    ASSERT_TRUE(result.view.probe && result.view.probe->drawn_lines) << result.log;
    ASSERT_EQ(result.view.probe->drawn_lines->size(), 1U);
    const std::vector<LinePoint>& line = result.view.probe->drawn_lines->front().line->points;
    ASSERT_GT(line.size(), 10U);
    const Vec3& first = line.front().position;
    for (const LinePoint& point : line) {
      const Vec3& x = point.position;
      EXPECT_NEAR(std::hypot(x.x, x.y), std::hypot(first.x, first.y), 1e-4);
      const double turn = (std::atan2(x.y, x.x) - x.z / 0.3) - (std::atan2(first.y, first.x) - first.z / 0.3);
      EXPECT_NEAR(std::remainder(turn, 2.0 * std::numbers::pi), 0.0, 1e-3);
    }
    EXPECT_GT(glm::distance(first, line.back().position), 0.05) << "the hand led along it";
  }
  /// Lines of u = (-y, x, 0.3) are closed forms of their times.
  static void expect_helices(const WindowResult& result) {
    for (const Line& line : *result.view.lines) {
      const auto at_seed =
          std::ranges::min_element(line.points, {}, [](const LinePoint& p) { return std::abs(p.time); });
      for (const LinePoint& p : line.points) {
        const double c = std::cos(p.time), s = std::sin(p.time);
        const Vec3& x = at_seed->position;
        EXPECT_LE(glm::distance(p.position, Vec3{c * x.x - s * x.y, s * x.x + c * x.y, x.z + 0.3 * p.time}),
                  p.error + 1e-5);
      }
    }
  }
};

TEST_F(FromFileToLine, OfAnOpenFoamCase) {
  const FoamBox box(6, border);
  const std::filesystem::path root = folder_.path("cavity");
  box.write_mesh(root, false);
  box.write_control(root);
  std::string walls = "border { type fixedValue; value nonuniform ";
  std::vector<Vec3> values;
  for (const Vec3& x : box.middles("border")) values.push_back(helix(x));
  walls += FoamBox::vectors(values, false) + "; }\n";
  box.write_vectors(
      root / "0/U", false, [](const Vec3&) { return Vec3{0.0}; }, kFree);
  box.write_vectors(root / "1/U", false, helix, walls);
  const WindowResult result = follow("cavity/");
  EXPECT_NE(result.document.input.time, "0") << "nothing moves there";
  expect_helices(result);
}

TEST_F(FromFileToLine, OfAnEnsightTransient) {
  constexpr int kPoints = 5;
  const auto column = [](const std::array<std::string, 3>& of) { return of[0] + of[1] + of[2]; };
  std::array<std::string, 3> at, moving, still;
  std::array<char, 16> number{};
  const auto add = [&](std::string& to, double value) {
    std::snprintf(number.data(), number.size(), "%12.5e\n", value);
    to += number.data();
  };
  for (int p = 0; p < kPoints * kPoints * kPoints; ++p) {
    const Vec3 x{0.5 * (p % kPoints) - 1.0, 0.5 * (p / kPoints % kPoints) - 1.0,
                 0.5 * (p / kPoints / kPoints)};
    for (int axis = 0; axis < 3; ++axis) {
      const auto a = static_cast<std::size_t>(axis);
      add(at[a], x[axis]);
      add(moving[a], helix(x)[axis]);
      add(still[a], 0.0);
    }
  }
  folder_.write(
      "run.geo",
      "a\nb\nnode id off\nelement id off\npart\n         1\nbox\nblock\n         5         5         5\n" +
          column(at));
  folder_.write("run.vel00", "v\npart\n         1\nblock\n" + column(still));
  folder_.write("run.vel01", "v\npart\n         1\nblock\n" + column(moving));
  folder_.write(
      "run.case",
      "FORMAT\ntype: ensight gold\nGEOMETRY\nmodel: run.geo\nVARIABLE\nvector per node: 1 velocity "
      "run.vel**\nTIME\ntime set: 1\nnumber of steps: 2\nfilename start number: 0\nfilename increment: "
      "1\ntime values: 0 0.5\n");
  expect_helices(follow("run.case"));
}

TEST_F(FromFileToLine, OfCellsWithPointsOfTheirOwn) {
  constexpr int kCells = 4;
  constexpr std::array<std::array<int, 3>, 8> kCorners{
      {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}}};
  std::string points, vectors, cells;
  int count = 0;
  for (int c = 0; c < kCells * kCells * kCells; ++c) {
    cells += "8";
    for (const auto& corner : kCorners) {
      const Vec3 x{0.5 * (c % kCells + corner[0]) - 1.0, 0.5 * (c / kCells % kCells + corner[1]) - 1.0,
                   0.5 * (c / kCells / kCells + corner[2])};
      const Vec3 v = helix(x);
      points += exact_number(x.x) + " " + exact_number(x.y) + " " + exact_number(x.z) + "\n";
      vectors += exact_number(v.x) + " " + exact_number(v.y) + " " + exact_number(v.z) + "\n";
      cells += " " + std::to_string(count++);
    }
    cells += "\n";
  }
  std::string types;
  for (int c = 0; c < kCells * kCells * kCells; ++c) types += "12\n";
  const std::string all = std::to_string(kCells * kCells * kCells), nodes = std::to_string(count);
  folder_.write("dg.vtk", "# vtk DataFile Version 3.0\nd\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS " + nodes +
                              " double\n" + points + "CELLS " + all + " " +
                              std::to_string(9 * kCells * kCells * kCells) + "\n" + cells + "CELL_TYPES " +
                              all + "\n" + types + "POINT_DATA " + nodes + "\nVECTORS U double\n" + vectors);
  expect_helices(follow("dg.vtk"));
}

}  // namespace
}  // namespace palpate::test
