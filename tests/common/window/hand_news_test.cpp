// What the window says of itself about hand and device.

#include "common/window/hand_news.h"

#include <gtest/gtest.h>

namespace palpate::test {
namespace {

TEST(HandNews, AStallOfTheMachineStandsBesideAnAnswer) {
  HandNews news;
  PanelState state;
  ProbeReadout hand;
  state.say("kept line 1");
  hand.servo.statistics.stalls = 1;
  news.follow(hand, false, state);
  EXPECT_EQ(state.message, "kept line 1");
  EXPECT_NE(state.aside.find("the machine was busy"), std::string::npos) << state.aside;
  EXPECT_NE(state.log.text().find("the machine was busy"), std::string::npos);
  state.say("let go");
  EXPECT_EQ(state.aside, "") << "the next answer begins anew";
  news.follow(hand, false, state);
  EXPECT_EQ(state.aside, "") << "said once";
}

TEST(HandNews, PoppingIsSaidOnceInTheWordsOfWhatIsFelt) {
  HandNews news;
  PanelState state;
  ProbeReadout hand;
  hand.popped = 1;
  news.follow(hand, false, state);
  EXPECT_EQ(state.message, "popped over to the next line");
  state.say("kept line 1");
  news.follow(hand, false, state);
  EXPECT_EQ(state.message, "kept line 1");
  hand.popped = 2;
  news.follow(hand, true, state);
  EXPECT_EQ(state.message, "popped through to the other side");
}

}  // namespace
}  // namespace palpate::test
