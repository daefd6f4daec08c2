#include "common/base/late.h"

#include <atomic>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

namespace palpate::test {
namespace {

TEST(Late, IsMadeOnceForAllCopiesAndForNobodyWhoDoesNotAsk) {
  std::atomic<int> made{0};
  const auto late = Late<std::string>::by([&made] { return "made " + std::to_string(++made); });
  const Late<std::string> copy = late;
  EXPECT_FALSE(late.made());
  EXPECT_EQ(made, 0);
  std::vector<std::thread> askers;
  for (int i = 0; i < 4; ++i) askers.emplace_back([copy] { EXPECT_EQ(copy.get(), "made 1"); });
  for (std::thread& asker : askers) asker.join();
  EXPECT_EQ(late.get(), "made 1");
  EXPECT_TRUE(late.made() && copy.made());
}

TEST(Late, IsAValueThatIsKnownOrNone) {
  const Late<std::string> known = std::string("known");
  EXPECT_TRUE(known.made());
  EXPECT_EQ(known.get(), "known");
  EXPECT_EQ(Late<std::string>().get(), "");
}

TEST(Late, SaysWhyItCannotBeMadeEachTime) {
  const auto late = Late<int>::by([]() -> int { throw std::runtime_error("no"); });
  EXPECT_THROW((void)late.get(), std::runtime_error);
  EXPECT_THROW((void)late.get(), std::runtime_error);
}

}  // namespace
}  // namespace palpate::test
