#include "common/window/controls/view_edits.h"

#include <gtest/gtest.h>

namespace palpate::test {
namespace {

const Box kRegion{{-0.5, -0.6, -0.7}, {0.25, 0.35, 0.45}};

TEST(ViewEdits, AreTakenBackInTheOrderOfPlanesAndView) {
  ViewEdits edits;
  PlanePoses planes;
  edits.follow({}, planes, true);
  EXPECT_FALSE(edits.undo(planes)) << "nothing was done";
  edits.follow({.region = kRegion}, planes, true);
  // A drag is one edit, however many frames it takes.
  EditedView view{.region = kRegion, .window = ValueWindow{.width = 2.0, .level = 1.0}};
  edits.follow(view, planes, false);
  view.window->width = 3.0;
  edits.follow(view, planes, false);
  edits.follow(view, planes, true);
  PlanePoses moved;
  moved.count = 1;
  EXPECT_FALSE(edits.undo(moved)) << "the planes were moved later";
  const auto first = edits.undo(planes);
  ASSERT_TRUE(first);
  EXPECT_FALSE(first->window);
  ASSERT_TRUE(first->region);
  EXPECT_EQ(first->region->upper, kRegion.upper);
  const auto second = edits.undo(planes);
  ASSERT_TRUE(second);
  EXPECT_FALSE(second->region);
  EXPECT_FALSE(edits.undo(planes));
}

}  // namespace
}  // namespace palpate::test
