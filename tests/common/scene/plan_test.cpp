#include "common/scene/plan.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "tests/support/shared_data.h"

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
  const std::string text = plan_text(plan);
  EXPECT_LT(text.find("window"), text.find("left out:"));
}

}  // namespace
}  // namespace palpate::test
