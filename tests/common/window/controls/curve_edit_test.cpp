// What a hand can do to a transfer function always leaves one that a chain can use.

#include "common/window/controls/curve_edit.h"

#include <random>
#include <string>

#include <gtest/gtest.h>

namespace palpate::test {
namespace {

using Knot = HapticTransferFunction::Knot;

HapticTransferFunction curve(const std::string& text) {
  HapticTransferFunction function;
  EXPECT_FALSE(HapticTransferFunction::read(text, function)) << text;
  return function;
}

constexpr CurveRange kRange{.low_measure = 0.0, .high_measure = 10.0, .low_value = 0.0, .high_value = 1.0};

TEST(CurveEdit, AKnotStaysBetweenItsNeighboursAndInTheRange) {
  HapticTransferFunction function = curve("0:0,4:0.5,10:1");
  move_knot(function, 1, {6.0, 0.25}, kRange);
  EXPECT_EQ(function, curve("0:0,6:0.25,10:1"));
  move_knot(function, 1, {20.0, 3.0}, kRange);
  EXPECT_EQ(function.knots()[1], (Knot{10.0 - kRange.gap(), 1.0}));
  move_knot(function, 1, {-20.0, -3.0}, kRange);
  EXPECT_EQ(function.knots()[1], (Knot{kRange.gap(), 0.0}));
  move_knot(function, 0, {5.0, 0.5}, kRange);
  EXPECT_EQ(function.knots()[0], (Knot{0.0, 0.5})) << "no room but its own place";
}

TEST(CurveEdit, AConstantIsMovedUpAndDown) {
  HapticTransferFunction function = curve("0.5");
  move_knot(function, 0, {7.0, 0.75}, kRange);
  EXPECT_EQ(function, curve("0.75"));
}

TEST(CurveEdit, AConstantBecomesACurveWithItsValueAtTheFarEnd) {
  HapticTransferFunction function = curve("0.5");
  EXPECT_TRUE(add_knot(function, {8.0, 1.0}, kRange));
  EXPECT_EQ(function, curve("0:0.5,8:1"));
  function = curve("0.5");
  EXPECT_TRUE(add_knot(function, {2.0, 1.0}, kRange));
  EXPECT_EQ(function, curve("2:1,10:0.5"));
}

TEST(CurveEdit, KnotsAreAddedInOrderUpToEight) {
  HapticTransferFunction function = curve("0:0,10:1,smooth");
  EXPECT_TRUE(add_knot(function, {5.0, 0.1}, kRange));
  EXPECT_EQ(function, curve("0:0,5:0.1,10:1,smooth"));
  EXPECT_FALSE(add_knot(function, {5.0 + 0.5 * kRange.gap(), 0.1}, kRange)) << "there is one";
  for (int i = 1; i <= 5; ++i) EXPECT_TRUE(add_knot(function, {5.0 + 0.5 * i, 0.2}, kRange));
  EXPECT_EQ(function.knots().size(), 8U);
  EXPECT_FALSE(add_knot(function, {1.0, 0.2}, kRange)) << "there are eight";
}

TEST(CurveEdit, TheLastKnotStays) {
  HapticTransferFunction function = curve("0:0,5:0.1,10:1,smooth");
  EXPECT_TRUE(remove_knot(function, 1));
  EXPECT_EQ(function, curve("0:0,10:1,smooth"));
  EXPECT_TRUE(remove_knot(function, 0));
  EXPECT_TRUE(function.constant());
  EXPECT_EQ(function(3.0), 1.0);
  EXPECT_FALSE(remove_knot(function, 0));
}

TEST(CurveEdit, SmoothIsForCurves) {
  HapticTransferFunction function = curve("0:0,10:1");
  set_smooth(function, true);
  EXPECT_EQ(function, curve("0:0,10:1,smooth"));
  set_smooth(function, false);
  EXPECT_EQ(function, curve("0:0,10:1"));
  function = curve("0.5");
  set_smooth(function, true);
  EXPECT_EQ(function, curve("0.5"));
}

TEST(CurveEdit, TheNearestKnotIsTakenHold) {
  const HapticTransferFunction function = curve("0:0,5:0.5,10:1");
  EXPECT_EQ(knot_near(function, {5.3, 0.52}, 0.07, kRange), 1U);
  EXPECT_EQ(knot_near(function, {9.8, 0.98}, 0.07, kRange), 2U);
  EXPECT_FALSE(knot_near(function, {7.5, 0.75}, 0.07, kRange));
  // A constant is held anywhere along its line.
  EXPECT_EQ(knot_near(curve("0.5"), {9.0, 0.52}, 0.07, kRange), 0U);
  EXPECT_FALSE(knot_near(curve("0.5"), {9.0, 0.7}, 0.07, kRange));
}

TEST(CurveEdit, TheRangeGrowsToWhatIsThere) {
  const CurveRange range = grown(kRange, curve("-2:0.5,20:3"));
  EXPECT_EQ(range.low_measure, -2.0);
  EXPECT_EQ(range.high_measure, 20.0);
  EXPECT_EQ(range.low_value, 0.0);
  EXPECT_EQ(range.high_value, 3.0);
  EXPECT_EQ(grown(kRange, curve("2")).high_measure, 10.0);
}

TEST(CurveEdit, NoRowOfEditsMakesAFunctionThatCannotBeUsed) {
  std::mt19937_64 random(3);
  const auto unit = [&] { return static_cast<double>(random() >> 11U) * 0x1p-53; };
  // A range far from zero, where a gap is a few units in the last place of a measure.
  for (const CurveRange& range : {kRange, CurveRange{.low_measure = 1e9, .high_measure = 1e9 + 1.0}}) {
    HapticTransferFunction function = curve("0.5");
    for (int n = 0; n < 4000; ++n) {
      const Knot at{range.low_measure + (3.0 * unit() - 1.0) * (range.high_measure - range.low_measure),
                    3.0 * unit() - 1.0};
      const auto knot = static_cast<std::size_t>(random() % function.knots().size());
      switch (random() % 4) {
        case 0:
          (void)add_knot(function, at, range);
          break;
        case 1:
          (void)remove_knot(function, knot);
          break;
        case 2:
          set_smooth(function, unit() < 0.5);
          break;
        default:
          move_knot(function, knot, at, range);
      }
      HapticTransferFunction again;
      ASSERT_FALSE(HapticTransferFunction::read(function.text(), again)) << function.text();
      ASSERT_EQ(again, function);
      ASSERT_GE(function.lowest(), range.low_value);
      ASSERT_LE(function.highest(), range.high_value);
    }
  }
}

}  // namespace
}  // namespace palpate::test
