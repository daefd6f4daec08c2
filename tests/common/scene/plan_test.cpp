#include "common/scene/plan.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "tests/support/temp_folder.h"

namespace palpate::test {
namespace {

const Need* find(const Needs& plan, const std::string& what) {
  const auto found =
      std::find_if(plan.begin(), plan.end(), [&](const Need& n) { return n.what.find(what) == 0; });
  return found == plan.end() ? nullptr : &*found;
}

TEST(Plan, OfAnExampleReadsNothing) {
  const Needs plan = plan_scene(Input::open({.example = "abc"}), {.verb = "trace", .tracing = true});
  ASSERT_NE(find(plan, "helper"), nullptr);
  EXPECT_FALSE(find(plan, "helper")->used);
  EXPECT_TRUE(find(plan, "tracing")->used);
  EXPECT_FALSE(find(plan, "window")->used);
}

TEST(Plan, NamesEachThingOnceAndSaysWhy) {
  const Needs plan = plan_scene(Input::open({.example = "abc"}),
                                {.verb = "open", .tracing = true, .drawing = true, .window = true});
  for (const Need& need : plan) {
    EXPECT_FALSE(need.why.empty()) << need.what;
    EXPECT_EQ(std::count_if(plan.begin(), plan.end(), [&](const Need& n) { return n.what == need.what; }), 1)
        << need.what;
  }
  EXPECT_NE(plan_text(plan).find("milliseconds expected"), std::string::npos);
  const std::string text = plan_text(plan);
  EXPECT_LT(text.find("window"), text.find("left out:"));
}

TEST(Plan, ExpectsCostsBeforeAnythingIsRead) {
  const TempFolder folder;
  std::string text =
      "# vtk DataFile Version 3.0\nt\nASCII\nDATASET STRUCTURED_GRID\nDIMENSIONS 3 3 3\nPOINTS 27 float\n";
  std::string values;
  for (int k = 0; k < 3; ++k) {
    for (int j = 0; j < 3; ++j) {
      for (int i = 0; i < 3; ++i) {
        text += std::to_string(i) + " " + std::to_string(j) + " " + std::to_string(k) + "\n";
        values += "1 0 0\n";
      }
    }
  }
  const auto file = folder.write("a.vtk", text + "POINT_DATA 27\nVECTORS v float\n" + values);
  const Input input = Input::open({.files = {file}});
  const SceneUse one{.verb = "trace", .tracing = true, .lines = 100, .threads = 1};
  SceneUse two = one;
  two.threads = 2;
  const Needs plan = plan_scene(input, one);
  for (const char* what : {"helper", "array v", "tetrahedra", "tracing 100 lines"}) {
    ASSERT_NE(find(plan, what), nullptr) << what;
    EXPECT_GT(find(plan, what)->milliseconds, 0.0) << what;
    EXPECT_TRUE(find(plan, what)->used) << what;
  }
  EXPECT_EQ(find(plan, "array v")->bytes, 27U * 12U);
  // What is shared among threads is expected to take less with more of them.
  for (const char* what : {"tetrahedra", "tracing"})
    EXPECT_DOUBLE_EQ(find(plan_scene(input, two), what)->milliseconds, find(plan, what)->milliseconds / 2)
        << what;
}

TEST(Plan, MeasuredCostsAreOneLine) {
  EXPECT_EQ(measured_text({{.what = "opening", .milliseconds = 8.5},
                           {.what = "field", .milliseconds = 154.0, .bytes = 13'200'000}}),
            "measured: opening 8.5 ms, field 154 ms (13.2 MB)\n");
}

}  // namespace
}  // namespace palpate::test
