#include "common/hand/drawn/drawn_lines.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>
#include <vtkDataArray.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkXMLPolyDataReader.h>

#include "common/base/error.h"
#include "tests/support/temp_folder.h"

namespace palpate {
namespace {

/// Points at x = 0, 1, 2, …
Line straight(int points, double shift = 0.0) {
  Line line;
  for (int i = 0; i < points; ++i) {
    line.points.push_back({.position = {i + shift, 0.0, 0.0}, .time = 0.5 * i, .arc = 1.0 * i, .speed = 2.0});
  }
  return line;
}

/// A hand that goes over these x, with the force 1, 2, 3, …
std::vector<HapticForce> hand_at(const std::vector<double>& places) {
  std::vector<HapticForce> felt;
  for (const double x : places) felt.push_back({{x, 0.0, 0.0}, static_cast<double>(felt.size() + 1)});
  return felt;
}

void expect_same(const std::vector<double>& forces, const std::vector<double>& expected) {
  ASSERT_EQ(forces.size(), expected.size());
  for (std::size_t i = 0; i < forces.size(); ++i) {
    if (std::isnan(expected[i])) {
      EXPECT_TRUE(std::isnan(forces[i])) << i << ": " << forces[i];
    } else {
      EXPECT_EQ(forces[i], expected[i]) << i;
    }
  }
}

TEST(ForcesAlong, AreNotANumberWhereTheHandDidNotPass) {
  expect_same(forces_along(straight(6), hand_at({2.0, 3.1, 3.9})), {NAN, NAN, 1.0, 2.0, 3.0, NAN});
  expect_same(forces_along(straight(3), {}), {NAN, NAN, NAN});
  EXPECT_TRUE(forces_along(Line{}, hand_at({1.0})).empty());
}

TEST(ForcesAlong, AreThoseFeltLastOnAPathForthAndBack) {
  expect_same(forces_along(straight(6), hand_at({1.0, 2.0, 3.0, 4.0, 3.0, 2.0})),
              {NAN, 1.0, 6.0, 5.0, 4.0, NAN});
}

TEST(ForcesAlong, CoverThePointsThatAFastHandPassed) {
  expect_same(forces_along(straight(8), hand_at({1.0, 5.0})), {NAN, 1.0, 2.0, 2.0, 2.0, 2.0, NAN, NAN});
}

TEST(ForcesAlong, StayOnThePartOfTheLineWhereTheHandIs) {
  // A line that comes back beside itself: two points of it lie near each place.
  Line line = straight(5);
  for (int i = 4; i >= 0; --i) line.points.push_back({.position = {1.0 * i, 0.4, 0.0}});
  std::vector<HapticForce> felt = hand_at({1.0, 2.0, 3.0});
  felt[1].position.y = 0.25;  // nearer to the other part, which the hand does not get to by going on
  const std::vector<double> forces = forces_along(line, felt);
  EXPECT_EQ(forces[2], 2.0);
  for (std::size_t i = 5; i < 10; ++i) EXPECT_TRUE(std::isnan(forces[i])) << i;
}

TEST(DrawnLines, KeepsRemovesAndGoesBack) {
  DrawnLines kept;
  kept.keep(straight(3), {0.5, NAN, 1.5});
  const auto one = kept.all();
  kept.keep(straight(4), {NAN, NAN, NAN, NAN});
  const auto two = kept.all();
  EXPECT_NE(one, two);
  ASSERT_EQ(kept.entries().size(), 2U);
  EXPECT_EQ(kept.entries()[0].number, 1);
  EXPECT_EQ(kept.entries()[0].largest_force, 1.5);
  EXPECT_EQ(kept.entries()[1].largest_force, 0.0);
  const auto drawn = kept.drawn();
  ASSERT_EQ(drawn->size(), 2U);
  EXPECT_EQ((*drawn)[1].number, 2);
  EXPECT_EQ((*drawn)[1].line, kept.entries()[1].line);

  kept.remove(0);
  ASSERT_EQ(kept.entries().size(), 1U);
  EXPECT_EQ(kept.entries()[0].number, 2);
  EXPECT_NE(kept.drawn(), drawn);
  kept.put(two);
  ASSERT_EQ(kept.entries().size(), 2U);
  EXPECT_EQ(kept.entries()[0].number, 1);
  kept.put(one);
  EXPECT_EQ(kept.entries().size(), 1U);
  EXPECT_EQ(kept.drawn()->size(), 1U);
  kept.keep(straight(2), {0.0, 0.0});
  EXPECT_EQ(kept.entries().back().number, 3) << "a number is not given twice";

  kept.clear();
  EXPECT_TRUE(kept.entries().empty());
  EXPECT_TRUE(kept.drawn()->empty());
  kept.keep(straight(2), {0.0, 0.0});
  EXPECT_EQ(kept.entries()[0].number, 1);
}

class DrawnLinesTest : public ::testing::Test {
 protected:
  void SetUp() override {
    kept_.keep(straight(3), {0.25, NAN, 1.0 / 3.0});
    kept_.keep(straight(2, 10.0), {NAN, 2.0});
    kept_.keep(straight(2, 20.0), {4.0, 5.0});
    kept_.remove(1);
  }

  test::TempFolder folder_;
  DrawnLines kept_;
  const std::vector<double> expected_{0.25, NAN, 1.0 / 3.0, 4.0, 5.0};
};

TEST_F(DrawnLinesTest, CarryTheirForceInVtp) {
  const auto file = folder_.path("lines.vtp");
  kept_.save(file, false);
  const auto reader = vtkSmartPointer<vtkXMLPolyDataReader>::New();
  reader->SetFileName(file.c_str());
  reader->Update();
  ASSERT_EQ(reader->GetErrorCode(), 0U);
  EXPECT_EQ(reader->GetOutput()->GetNumberOfLines(), 2);
  vtkDataArray* const force = reader->GetOutput()->GetPointData()->GetArray("force");
  ASSERT_NE(force, nullptr);
  std::vector<double> forces;
  for (vtkIdType i = 0; i < force->GetNumberOfTuples(); ++i) forces.push_back(force->GetComponent(i, 0));
  expect_same(forces, expected_);
}

TEST_F(DrawnLinesTest, CarryTheirForceAndNumberInCsv) {
  const auto file = folder_.path("lines.csv");
  kept_.save(file, false);
  std::istringstream text(test::read_file(file));
  std::string row;
  ASSERT_TRUE(std::getline(text, row));
  const auto cells_of = [](const std::string& of) {
    std::vector<std::string> cells;
    std::istringstream parts(of);
    for (std::string cell; std::getline(parts, cell, ',');) cells.push_back(cell);
    return cells;
  };
  const std::vector<std::string> names = cells_of(row);
  const auto column = [&](const char* name) {
    return static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
  };
  ASSERT_LT(column("force"), names.size());
  std::vector<double> forces;
  std::vector<int> numbers;
  while (std::getline(text, row)) {
    const std::vector<std::string> cells = cells_of(row);
    ASSERT_EQ(cells.size(), names.size());
    forces.push_back(std::stod(cells[column("force")]));
    numbers.push_back(std::stoi(cells[column("seed")]));
  }
  expect_same(forces, expected_);
  EXPECT_EQ(numbers, (std::vector<int>{1, 1, 1, 3, 3}));
}

TEST_F(DrawnLinesTest, ComeBackFromCsvToTheBit) {
  DrawnTract tract{straight(3, 30.0), {NAN, 0.5, NAN}, {}};
  tract.line.end = End::kLoop;
  for (LinePoint& point : tract.line.points) {
    point.time = -1.0 / (3.0 + point.position.x);
    point.arc = std::abs(point.time);
    point.speed = 1.0 / 7.0;
    point.error = 1e-9;
    tract.measures.push_back({{0.25, 0.5, 0.25}, point.time + 1.0});
  }
  DrawnLines kept;
  kept.keep({tract, tract});
  kept.remove(0);
  const auto file = folder_.path("lines.csv");
  for (const DrawnLines* lines : std::initializer_list<const DrawnLines*>{&kept_, &kept}) {
    lines->save(file, true);
    const auto read = read_drawn_lines(file);
    ASSERT_EQ(read->size(), lines->entries().size());
    for (std::size_t l = 0; l < read->size(); ++l) {
      const DrawnLines::Entry &now = (*read)[l], &before = lines->entries()[l];
      EXPECT_EQ(now.number, before.number);
      EXPECT_EQ(now.largest_force, before.largest_force);
      EXPECT_EQ(now.line->end, before.line->end);
      expect_same(now.forces, before.forces);
      ASSERT_EQ(now.line->points.size(), before.line->points.size());
      ASSERT_EQ(now.measures.size(), before.measures.size());
      for (std::size_t i = 0; i < now.line->points.size(); ++i) {
        const LinePoint &p = now.line->points[i], &q = before.line->points[i];
        EXPECT_EQ(p.position, q.position);
        EXPECT_EQ(std::tie(p.time, p.arc, p.speed, p.error), std::tie(q.time, q.arc, q.speed, q.error));
      }
      for (std::size_t i = 0; i < now.measures.size(); ++i) {
        EXPECT_EQ(now.measures[i].parts.linear, before.measures[i].parts.linear);
        EXPECT_EQ(now.measures[i].parts.planar, before.measures[i].parts.planar);
        EXPECT_EQ(now.measures[i].fractional_anisotropy, before.measures[i].fractional_anisotropy);
      }
    }
    // Written again, it is the same file.
    DrawnLines again;
    again.put(read);
    const auto second = folder_.path("again.csv");
    again.save(second, true);
    EXPECT_EQ(test::read_file(second), test::read_file(file));
  }
}

TEST_F(DrawnLinesTest, ADamagedTableIsRefusedWithItsLine) {
  const std::string header = "line,seed,point,x,y,z,termination\n",
                    good = "0,1,0,0,0,0,loop\n0,1,1,1,0,0,loop\n";
  const auto refusal = [&](const std::string& text) -> std::string {
    try {
      (void)read_drawn_lines(folder_.write("t.csv", text));
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ExitCode::kBadInput);
      return error.what();
    }
    return "accepted";
  };
  EXPECT_EQ(refusal(header + good), "accepted");
  EXPECT_EQ(refusal(header), "accepted") << "no line is none";
  for (const char* bad : {"1,2,0,0,0\n", "1,2,0,0,0,nan,loop\n", "1,x,0,0,0,0,loop\n", "1,1.5,0,0,0,0,loop\n",
                          "1,-1,0,0,0,0,loop\n", "1,2,0,0,0,0,lo\n"})
    EXPECT_NE(refusal(header + good + bad).find("line 4"), std::string::npos)
        << bad << refusal(header + good + bad);
  EXPECT_NE(refusal(header + good + "1,2,0,0,0,0,loop\n").find("one point"), std::string::npos);
  EXPECT_NE(refusal("x,y,z\n").find("has no column line"), std::string::npos);
  EXPECT_NE(refusal("").find("is empty"), std::string::npos);
  try {
    (void)read_drawn_lines(folder_.path("missing.csv"));
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("missing.csv"), std::string::npos);
  }
}

TEST_F(DrawnLinesTest, DoNotReplaceAFileUnasked) {
  const auto file = folder_.write("lines.csv", "mine");
  EXPECT_THROW(kept_.save(file, false), Error);
  EXPECT_EQ(test::read_file(file), "mine");
  kept_.save(file, true);
  EXPECT_NE(test::read_file(file), "mine");
}

}  // namespace
}  // namespace palpate
