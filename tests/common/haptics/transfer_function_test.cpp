// Transfer functions: values worked out by hand, what monotone cubics promise, and the grammar.

#include "common/haptics/transfer_function.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include "common/base/text.h"

namespace palpate {
namespace {

HapticTransferFunction function_of(const std::string& text, double unit = 1.0) {
  HapticTransferFunction function;
  EXPECT_EQ(HapticTransferFunction::read(text, function, unit), std::nullopt) << text;
  return function;
}

std::string problem_of(const std::string& text) {
  HapticTransferFunction function(7.0);
  const auto problem = HapticTransferFunction::read(text, function);
  EXPECT_EQ(function, HapticTransferFunction(7.0)) << "left as it was";
  return problem.value_or("");
}

TEST(TransferFunction, IsConstantOrLinearBetweenItsKnots) {
  EXPECT_EQ(HapticTransferFunction(0.5)(-1e300), 0.5);
  EXPECT_EQ(function_of("0.5"), HapticTransferFunction(0.5));
  const auto f = function_of("1:2, 3:6 ,4:5");
  EXPECT_EQ(f(-HUGE_VAL), 2.0);
  EXPECT_EQ(f(1.0), 2.0);
  EXPECT_EQ(f(1.5), 3.0);
  EXPECT_EQ(f(3.0), 6.0);
  EXPECT_EQ(f(3.25), 5.75);
  EXPECT_EQ(f(4.0), 5.0);
  EXPECT_EQ(f(HUGE_VAL), 5.0);
  EXPECT_EQ(f.lowest(), 2.0);
  EXPECT_EQ(f.highest(), 6.0);
}

// Knots 0:0, 1:1, 3:2: chords 1 and 1/2, w_1 = 1 + 4 = 5, w_2 = 2 + 2 = 4, 1/d = (5 + 8) / 9, d = 9/13. At
// 1/2 the cubic of (0, 0), slope 0, to (1, 1), slope d is 1/2 - d/8.
TEST(TransferFunction, SmoothOnesFollowTheMonotoneCubic) {
  const auto f = function_of("0:0,1:1,3:2,smooth");
  EXPECT_DOUBLE_EQ(f(0.5), 0.5 - 9.0 / 13.0 / 8.0);
  EXPECT_DOUBLE_EQ(f(2.0), 1.5 + 2.0 * (9.0 / 13.0) / 8.0);
  EXPECT_EQ(f(1.0), 1.0);
  EXPECT_EQ(f(5.0), 2.0);
  const auto step = function_of("0:1,1:0,smooth");  // between two constants: the smooth step
  EXPECT_DOUBLE_EQ(step(0.25), 1.0 - 0.0625 * 2.5);
}

// Between two knots it never leaves their range, keeps its direction, and has no corner.
TEST(TransferFunction, SmoothOnesAreMonotoneBetweenKnotsAndHaveNoCorners) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> unit;
  for (int n = 0; n < 200; ++n) {
    std::string text;
    std::vector<HapticTransferFunction::Knot> knots;
    double at = unit(random);
    for (int i = 0; i < 8; ++i) {
      knots.push_back({at, std::round(4.0 * unit(random)) / 4.0});  // equal ones too
      text += exact_number(knots.back().measure) + ":" + exact_number(knots.back().value) + ",";
      at += std::pow(10.0, 3.0 * unit(random) - 3.0);
    }
    const auto f = function_of(text + "smooth");
    for (std::size_t i = 0; i + 1 < knots.size(); ++i) {
      const double width = knots[i + 1].measure - knots[i].measure;
      const double rise = knots[i + 1].value - knots[i].value;
      double last = knots[i].value;
      for (int k = 1; k <= 50; ++k) {
        const double now = f(knots[i].measure + width * k / 50.0);
        EXPECT_GE((now - last) * (rise < 0.0 ? -1.0 : 1.0), -1e-12) << text << " at " << i;
        last = now;
      }
      const double aside = 1e-6 * width;
      const double here = f(knots[i].measure), before = f(knots[i].measure - aside);
      const double after = f(knots[i].measure + aside);
      // A corner would be as steep as a chord: 1e-6 of the rise to either side. Second order is far less.
      const double most = i > 0 ? std::abs(knots[i].value - knots[i - 1].value) *
                                      (width / (knots[i].measure - knots[i - 1].measure))
                                : 0.0;
      EXPECT_LE(std::abs(after - 2.0 * here + before), 1e-8 * (std::abs(rise) + most) + 1e-12) << text;
    }
  }
}

TEST(TransferFunction, ReadsBackToTheLastBit) {
  for (const char* text : {"0.1", "-1:0.3,0.7:1e-300", "0.1:0.3,0.7:0.1,1e+300:0,smooth"}) {
    EXPECT_EQ(function_of(text).text(), text);
    EXPECT_EQ(function_of(function_of(text).text()), function_of(text));
  }
  EXPECT_EQ(function_of("0.2:1,0.6:4", 1e-3)(0.6), 4e-3) << "millimetres";
  EXPECT_EQ(function_of("0.2:1,0.6:4", 1e-3).text(1e-3), "0.2:1,0.6:4");
}

TEST(TransferFunction, RefusesWhatIsNone) {
  EXPECT_EQ(problem_of(""), "'' is no number");
  EXPECT_EQ(problem_of("stiff"), "'stiff' is no number");
  EXPECT_EQ(problem_of("nan"), "knots are finite numbers");
  EXPECT_EQ(problem_of("0:1,1:inf"), "knots are finite numbers");
  EXPECT_EQ(problem_of("nan:1,1:0"), "knots are finite numbers");
  EXPECT_EQ(problem_of("1:0,1:2"), "knots rise: 1 follows 1");
  EXPECT_EQ(problem_of("1:0,2:1,0.5:2"), "knots rise: 0.5 follows 2");
  EXPECT_EQ(problem_of("1:0,2"), "'2' is no knot, as 0.2:1 is");
  EXPECT_EQ(problem_of("1:0,,2:1"), "'' is no knot, as 0.2:1 is");
  EXPECT_EQ(problem_of("1:0,2:1,rough"), "'rough' is no knot, as 0.2:1 is");
  EXPECT_EQ(problem_of("smooth"), "knots are expected, as in 0.2:1,0.6:4,smooth");
  EXPECT_EQ(problem_of("1:1,smooth"), "one knot is a constant, and not smooth");
  EXPECT_EQ(problem_of("0:0,1e-320:1"), "knots at 0 and 9.99989e-321 are too close or too far apart");
  EXPECT_EQ(problem_of("-1e308:0,1e308:1").substr(0, 8), "knots at");
  EXPECT_EQ(problem_of("1:1,2:1,3:1,4:1,5:1,6:1,7:1,8:1,9:1"), "at most 8 knots, found 9");
}

TEST(TransferFunction, KeepsItsBitsUnderPowersOfTwo) {
  const auto plain = function_of("0.3:0.1,0.75:0.9,1.9:0.4,smooth");
  const auto scaled =
      function_of(exact_number(std::ldexp(0.3, 40)) + ":0.1," + exact_number(std::ldexp(0.75, 40)) + ":0.9," +
                  exact_number(std::ldexp(1.9, 40)) + ":0.4,smooth");
  for (double m = 0.0; m < 2.5; m += 0.01) EXPECT_EQ(plain(m), scaled(std::ldexp(m, 40)));
}

}  // namespace
}  // namespace palpate
