#include "common/base/ledger.h"

#include <thread>
#include <vector>

#include <gtest/gtest.h>

namespace palpate::test {
namespace {

class LedgerTest : public testing::Test {
 protected:
  void SetUp() override { Ledger::clear(); }
  void TearDown() override { Ledger::clear(); }
};

TEST_F(LedgerTest, HoldsAnOfferAsLeftOutUntilItIsTaken) {
  Ledger::offer("window", "nothing was shown");
  EXPECT_EQ(Ledger::entries().front().times, 0U);
  EXPECT_EQ(Ledger::entries().front().why, "nothing was shown");
  Ledger::enter("window", "to look", 2.0, 30);
  Ledger::offer("window", "nothing was shown");
  Ledger::enter("window", "again", 3.0, 20);
  ASSERT_EQ(Ledger::entries().size(), 1U);
  const LedgerEntry entry = Ledger::entries().front();
  EXPECT_EQ(entry.why, "to look");
  EXPECT_EQ(entry.times, 2U);
  EXPECT_EQ(entry.milliseconds, 5.0);
  EXPECT_EQ(entry.bytes, 30U);
}

TEST_F(LedgerTest, EntersWorkHoweverItsScopeEnds) {
  try {
    Work work("array v", "read");
    work.takes(24);
    throw 1;
  } catch (int) {
  }
  const LedgerEntry entry = Ledger::entries().front();
  EXPECT_EQ(entry.what, "array v");
  EXPECT_EQ(entry.bytes, 24U);
  EXPECT_GE(entry.milliseconds, 0.0);
}

TEST_F(LedgerTest, CountsWhatManyThreadsDo) {
  std::vector<std::thread> threads;
  for (int t = 0; t < 4; ++t) {
    threads.emplace_back([] {
      for (int i = 0; i < 1000; ++i) Ledger::enter("line", "", 1.0);
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(Ledger::entries().front().times, 4000U);
  EXPECT_EQ(Ledger::entries().front().milliseconds, 4000.0);
}

TEST_F(LedgerTest, AddsWhatAnotherProcessDid) {
  Ledger::offer("drawing", "no picture");
  Ledger::add({{.what = "drawing", .why = "640 x 480", .times = 3, .milliseconds = 9.0, .bytes = 5},
               {.what = "window", .why = "nothing was shown"}});
  const std::string text = ledger_text(Ledger::entries());
  EXPECT_NE(text.find("drawing, 3 times: 640 x 480"), std::string::npos) << text;
  EXPECT_LT(text.find("left out:"), text.find("window: nothing was shown")) << text;
}

}  // namespace
}  // namespace palpate::test
