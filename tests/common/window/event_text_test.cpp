#include "common/window/event_text.h"

#include <vector>

#include <gtest/gtest.h>

namespace palpate {
namespace {

void expect_same(const InputEvent& a, const InputEvent& b) {
  EXPECT_EQ(a.kind, b.kind);
  EXPECT_EQ(a.x, b.x);
  EXPECT_EQ(a.y, b.y);
  EXPECT_EQ(a.button, b.button);
  EXPECT_EQ(a.key, b.key);
  EXPECT_EQ(a.modifiers, b.modifiers);
}

TEST(EventText, ReadsBackToTheLastBit) {
  const std::vector<InputEvent> events{
      {.kind = InputKind::kMove, .x = 1000.0 / 3.0, .y = -0.1},
      {.kind = InputKind::kPress, .button = MouseButton::kMiddle},
      {.kind = InputKind::kRelease, .button = MouseButton::kRight},
      {.kind = InputKind::kWheel, .x = 0.0, .y = -1.5},
      {.kind = InputKind::kKeyDown, .key = 'Z', .modifiers = kModifierControl | kModifierShift},
      {.kind = InputKind::kKeyUp, .key = 344},
      {.kind = InputKind::kText, .key = 0x1F642}};
  for (const InputEvent& event : events) {
    const std::string text = event_text(event);
    EXPECT_EQ(text.find('\n'), std::string::npos);
    const auto back = event_from_text(text);
    ASSERT_TRUE(back) << text;
    expect_same(*back, event);
  }
  EXPECT_EQ(event_text(events[1]), "press 2");
  EXPECT_EQ(event_text({.kind = InputKind::kKeyDown, .key = 71}), "keydown 71 0");
}

TEST(EventText, LeavesDroppedFilesOut) {
  EXPECT_EQ(event_text({.kind = InputKind::kDrop, .files = {"a.vtk"}}), "");
}

TEST(EventText, IsNoEventWhereItMakesNoSense) {
  for (const char* text : {"", " ", "drop a.vtk", "move", "move 1", "move x y", "press", "press 3",
                           "press -1", "keydown", "keydown 71", "keydown a b", "Move 1 2", "wheel 1"}) {
    EXPECT_FALSE(event_from_text(text)) << text;
  }
}

}  // namespace
}  // namespace palpate
