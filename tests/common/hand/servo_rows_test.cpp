#include "common/hand/servo_rows.h"

#include <map>
#include <string>

#include <gtest/gtest.h>

namespace palpate::test {
namespace {

std::map<std::string, std::string> told(const ServoState& state) {
  std::map<std::string, std::string> rows;
  for (const ServoRow& row : servo_rows(state)) rows[row.name] = row.value;
  return rows;
}

TEST(ServoRows, SayNothingBeforeTheFirstTick) { EXPECT_TRUE(servo_rows({}).empty()); }

TEST(ServoRows, TellRateJitterOverrunsAndWhatWasGranted) {
  ServoState state;
  state.rate = 2000.0;
  state.real_time.memory_locked = true;
  ServoStatistics& statistics = state.statistics;
  statistics.ticks = 1000;
  statistics.late = 5;
  statistics.overruns = 2;
  statistics.skipped = 7;
  for (int i = 0; i < 999; ++i) statistics.update.add(4000);
  statistics.update.add(1'234'567);
  const auto rows = told(state);
  EXPECT_EQ(rows.at("servo"), "2000 Hz, 1000 ticks");
  EXPECT_EQ(rows.at("real time"), "no priority granted, memory locked");
  EXPECT_EQ(rows.at("late"), "0.5 % by over half a period");
  EXPECT_EQ(rows.at("overruns"), "2, 7 ticks skipped");
  // A percentile is known to the end of its bin, an eighth of an octave.
  EXPECT_EQ(rows.at("update"), "4.1 us, 99 % below 4.1, 99.9 % below 4.1, at most 1235");
  EXPECT_FALSE(rows.contains("faults"));
  EXPECT_FALSE(rows.contains("stalls"));
  statistics.faults = 3;
  statistics.stalls = 1;
  EXPECT_EQ(told(state).at("faults"), "3");
  EXPECT_EQ(told(state).at("stalls"), "1, the device was stopped");
}

}  // namespace
}  // namespace palpate::test
