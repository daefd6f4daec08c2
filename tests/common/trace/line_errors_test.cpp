#include "common/trace/line_errors.h"

#include <gtest/gtest.h>

namespace palpate::test {
namespace {

Line line_of(std::uint32_t seed, double arc, double error) {
  Line line{.seed = seed};
  // The largest estimate need not be the last.
  line.points = {{.error = 1e-16}, {.arc = 0.5 * arc, .error = error}, {.arc = arc, .error = 0.5 * error}};
  return line;
}

TEST(LineErrors, CountLinesThatAreNotHeldApart) {
  std::vector<Line> lines;
  for (std::uint32_t i = 0; i < 100; ++i) lines.push_back(line_of(i, 1.0, 1e-6 * (i + 1)));
  lines.push_back(line_of(100, 20.0, 1.0));
  lines.push_back(line_of(107, 20.0, 10.0));
  const LineErrors errors = line_errors(lines, 10.0, 5e-6);
  EXPECT_EQ(errors.max, 10.0);
  EXPECT_EQ(errors.held, 100U);
  EXPECT_DOUBLE_EQ(errors.median, 50e-6);
  EXPECT_DOUBLE_EQ(errors.p95, 95e-6);
  EXPECT_DOUBLE_EQ(errors.worst, 100e-6);
  EXPECT_EQ(errors.unheld_seeds, (std::vector<std::uint32_t>{100, 107}));
  EXPECT_EQ(errors.within, 50U);  // 5e-6 of a diagonal of 10
  EXPECT_EQ(errors_text(errors), "error median 5e-05, 95 % 9.5e-05, worst 0.0001, 2 lines not held");
}

TEST(LineErrors, AllowTheToleranceForEachDiagonalTravelled) {
  const std::vector<Line> lines{line_of(0, 0.1, 0.9e-6), line_of(1, 3.0, 2.9e-6), line_of(2, 3.0, 3.1e-6)};
  EXPECT_EQ(line_errors(lines, 1.0, 1e-6).within, 2U);
  EXPECT_FALSE(line_errors(lines, 1.0).within);
}

TEST(LineErrors, OfNoLineAreNone) {
  EXPECT_EQ(line_errors({}, 1.0, 1e-6).held, 0U);
  const std::vector<Line> wild{line_of(4, 1.0, 1.0)};
  EXPECT_EQ(errors_text(line_errors(wild, 1.0)), "error: 1 line not held");
}

}  // namespace
}  // namespace palpate::test
