#include "common/scene/document/history.h"

#include <gtest/gtest.h>

namespace palpate::test {
namespace {

Document with_width(double width) {
  Document document;
  document.view.line_width = width;
  return document;
}

TEST(DocumentHistory, GoesBackAndForthByEdits) {
  DocumentHistory history{Document()};
  EXPECT_FALSE(history.can_undo());
  history.push(with_width(4.0), "width");
  history.push(with_width(5.0), "width");
  EXPECT_EQ(history.undo().view.line_width, 4.0);
  EXPECT_EQ(history.undo_name(), "width");
  EXPECT_TRUE(history.undo() == Document());
  EXPECT_FALSE(history.can_undo());
  EXPECT_EQ(history.redo().view.line_width, 4.0);
  EXPECT_EQ(history.redo().view.line_width, 5.0);
  EXPECT_FALSE(history.can_redo());
}

TEST(DocumentHistory, ForgetsWhatWasUndoneAtAnotherEdit) {
  DocumentHistory history{Document()};
  history.push(with_width(4.0), "width");
  history.undo();
  history.push(with_width(6.0), "width");
  EXPECT_FALSE(history.can_redo());
  EXPECT_TRUE(history.undo() == Document());
}

TEST(DocumentHistory, TakesADragAsOneStep) {
  DocumentHistory history{Document()};
  for (const double width : {4.0, 5.0, 6.0}) history.push(with_width(width), "width", true);
  history.end_drag();
  history.push(with_width(7.0), "width", true);
  EXPECT_EQ(history.undo().view.line_width, 6.0);
  EXPECT_TRUE(history.undo() == Document());
}

TEST(DocumentHistory, TakesNoStepWhereNothingChanged) {
  DocumentHistory history{Document()};
  Document same;
  same.given = {"line-width"};
  history.push(same, "nothing");
  EXPECT_FALSE(history.can_undo());
}

TEST(DocumentHistory, KeepsTheLatestSteps) {
  DocumentHistory history{Document()};
  const auto edits = static_cast<int>(DocumentHistory::kMostSteps) + 10;
  for (int i = 1; i <= edits; ++i) history.push(with_width(10.0 + i), "width");
  int steps = 0;
  while (history.can_undo()) {
    history.undo();
    ++steps;
  }
  EXPECT_EQ(steps, static_cast<int>(DocumentHistory::kMostSteps));
  EXPECT_EQ(history.now().view.line_width, 20.0);
}

}  // namespace
}  // namespace palpate::test
