// Numbers and words in text: what is read whole, and what is refused.

#include "common/base/text.h"

#include <cmath>
#include <cstdint>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

namespace palpate::test {
namespace {

TEST(Parsed, TakesAllOfTheTextOrNothing) {
  EXPECT_EQ(parsed<int>("-12"), -12);
  EXPECT_EQ(parsed<double>("2.5e-3"), 2.5e-3);
  for (const char* text : {"", " 1", "1 ", "+1", "1x", "x"}) {
    EXPECT_FALSE(parsed<int>(text)) << "'" << text << "'";
  }
}

TEST(Parsed, RefusesWhatTheTypeDoesNotHold) {
  EXPECT_EQ(parsed<std::uint8_t>("255"), 255);
  EXPECT_FALSE(parsed<std::uint8_t>("256"));
  EXPECT_FALSE(parsed<std::uint64_t>("-1"));
  EXPECT_FALSE(parsed<std::uint64_t>("18446744073709551616"));
}

TEST(Words, StandBetweenBlanksOfAnyKind) {
  EXPECT_EQ(words(" \t12  ab\r\nc\v\f"), (std::vector<std::string_view>{"12", "ab", "c"}));
  EXPECT_TRUE(words(" \n").empty());
  EXPECT_TRUE(words("").empty());
}

TEST(Joined, IsWhatSplitTakesApart) {
  EXPECT_EQ(joined({}, ", "), "");
  EXPECT_EQ(joined({"a"}, ", "), "a");
  EXPECT_EQ(joined({"", "b", ""}, ", "), ", b, ") << "empty parts count";
}

TEST(CsvNumber, HasAWordForWhatIsNoNumber) {
  EXPECT_EQ(csv_number(0.1), "0.1");
  EXPECT_EQ(csv_number(HUGE_VAL), "nan");
  EXPECT_EQ(csv_number(std::nan("")), "nan");
}

TEST(IsBlank, IsThatOfTheCLocale) {
  for (const char c : std::string(" \t\n\v\f\r")) EXPECT_TRUE(is_blank(c)) << static_cast<int>(c);
  for (const char c : std::string("a,\b\x0e\x7f")) EXPECT_FALSE(is_blank(c)) << static_cast<int>(c);
}

TEST(Trimmed, LeavesBlanksInside) {
  EXPECT_EQ(trimmed(" \ta b\r\n"), "a b");
  EXPECT_EQ(trimmed(" \v\f"), "");
}

TEST(Lowered, ChangesLettersAlone) { EXPECT_EQ(lowered("NIfTI-[Z@\xc3\x84"), "nifti-[z@\xc3\x84"); }

}  // namespace
}  // namespace palpate::test
