#include "common/base/history.h"

#include <string>

#include <gtest/gtest.h>

namespace palpate::test {
namespace {

using Words = History<std::string>;

TEST(History, GoesBackAndForthByEdits) {
  Words history("");
  EXPECT_FALSE(history.can_undo());
  history.push("a");
  history.push("ab");
  EXPECT_EQ(history.undo(), "a");
  EXPECT_EQ(history.undo(), "");
  EXPECT_FALSE(history.can_undo());
  EXPECT_EQ(history.redo(), "a");
  EXPECT_EQ(history.redo(), "ab");
  EXPECT_FALSE(history.can_redo());
}

TEST(History, ForgetsWhatWasUndoneAtAnotherEdit) {
  Words history("");
  history.push("a");
  history.undo();
  history.push("b");
  EXPECT_FALSE(history.can_redo());
  EXPECT_EQ(history.undo(), "");
}

TEST(History, TakesNoStepWhereNothingChanged) {
  Words history("");
  history.push("");
  EXPECT_FALSE(history.can_undo());
  history.push("a");
  history.undo();
  history.push("");
  EXPECT_TRUE(history.can_redo());
}

TEST(History, SettlesWithoutAStep) {
  Words history("");
  history.push("a");
  history.settle("A");
  EXPECT_EQ(history.now(), "A");
  EXPECT_EQ(history.undo(), "");
  EXPECT_EQ(history.redo(), "A");
}

// Else the first undo after it would do nothing that is seen.
TEST(History, AnEditThatCameToNothingIsNoStep) {
  Words history("");
  history.push("a");
  history.push("bad");
  history.fail("a");
  EXPECT_EQ(history.undo(), "");
  EXPECT_FALSE(history.can_undo());
}

TEST(History, KeepsTheLatestSteps) {
  Words history("");
  const std::size_t edits = Words::kMostSteps + 10;
  for (std::size_t i = 1; i <= edits; ++i) history.push(std::to_string(i));
  std::size_t steps = 0;
  for (; history.can_undo(); ++steps) history.undo();
  EXPECT_EQ(steps, Words::kMostSteps);
  EXPECT_EQ(history.now(), "10");
}

}  // namespace
}  // namespace palpate::test
