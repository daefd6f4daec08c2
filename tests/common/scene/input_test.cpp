#include "common/scene/input.h"

#include <gtest/gtest.h>

#include "common/base/error.h"

namespace palpate::test {
namespace {

ExitCode code_of(const InputOptions& spec) {
  try {
    (void)Input::open(spec);
  } catch (const Error& error) {
    return error.code();
  }
  return ExitCode::kDone;
}

TEST(ChooseTime, TakesFirstLastAndTheNearest) {
  const std::vector<double> times{0.0, 0.5, 1.0};
  EXPECT_EQ(choose_time(times, "first").step, 0U);
  EXPECT_EQ(choose_time(times, "last").step, 2U);
  EXPECT_EQ(choose_time(times, "0.5").step, 1U);
  EXPECT_TRUE(choose_time(times, "0.5").exact);
  EXPECT_EQ(choose_time(times, "0.8").step, 2U);
  EXPECT_FALSE(choose_time(times, "0.8").exact);
  EXPECT_EQ(choose_time({}, "last").step, 0U);
}

TEST(ChooseTime, RefusesTimesFarOutsideAndWordsThatAreNone) {
  EXPECT_THROW((void)choose_time({0.0, 0.5, 1.0}, "7"), Error);
  EXPECT_THROW((void)choose_time({0.0, 0.5, 1.0}, "-7"), Error);
  EXPECT_THROW((void)choose_time({0.0, 0.5, 1.0}, "nan"), Error);
  EXPECT_THROW((void)choose_time({0.0, 0.5, 1.0}, "soon"), Error);
  EXPECT_THROW((void)choose_time({0.0, 0.5, 1.0}, "1s"), Error);
  EXPECT_THROW((void)choose_time({2.0}, "3"), Error);
  EXPECT_THROW((void)choose_time({}, "1"), Error);
}

TEST(Input, WantsOneOfFilesAndExample) {
  EXPECT_EQ(code_of({}), ExitCode::kUsage);
  EXPECT_EQ(code_of({.files = {"a.vtk"}, .example = "abc"}), ExitCode::kUsage);
  EXPECT_EQ(code_of({.example = "no-such-example"}), ExitCode::kUsage);
  EXPECT_EQ(code_of({.example = "abc", .field = "pressure"}), ExitCode::kUsage);
  EXPECT_EQ(code_of({.example = "abc", .time = "3"}), ExitCode::kUsage);
  EXPECT_EQ(code_of({.files = {"/no/such/file.vtk"}}), ExitCode::kBadInput);
}

TEST(Input, MakesTheFieldOfAnExample) {
  Input input = Input::open({.example = "abc"});
  EXPECT_EQ(input.title(), "example abc");
  EXPECT_EQ(input.file(), nullptr);
  EXPECT_NE(input.load_field(1)->analytic(), nullptr);
}

// In the order of time, whatever that of the file, and round at either end.
TEST(TimeSteps, GoOnByTimeAndRound) {
  const std::vector<double> times{0.5, 0.0, 2.0, 1.0};
  EXPECT_EQ(step_beside(times, 1, true), 0U);
  EXPECT_EQ(step_beside(times, 0, true), 3U);
  EXPECT_EQ(step_beside(times, 2, true), 1U);
  EXPECT_EQ(step_beside(times, 1, false), 2U);
  for (std::size_t step = 0; step < times.size(); ++step)
    EXPECT_EQ(step_beside(times, step_beside(times, step, true), false), step);
  EXPECT_EQ(nearest_step(times, 1.4), 3U);
  EXPECT_EQ(nearest_step(times, -7.0), 1U);
  EXPECT_EQ(nearest_step(times, 9.0), 2U);
}

}  // namespace
}  // namespace palpate::test
