#include "common/hand/servo_rows.h"

#include <array>
#include <cstdio>

#include "common/base/index.h"
#include "common/base/text.h"

namespace palpate {
namespace {

/// "3.1 us, 99 % below 8.2, 99.9 % below 11.0, at most 400"
std::string spread(const TimeHistogram& times) {
  const auto us = [](std::uint64_t ns) {
    constexpr double kMicroseconds = 1e-3, kLong = 100.0;
    const double time = kMicroseconds * static_cast<double>(ns);
    std::array<char, 32> text{};
    (void)std::snprintf(text.data(), text.size(), time < kLong ? "%.1f" : "%.0f", time);
    return std::string(text.data());
  };
  return us(times.percentile_ns(0.5)) + " us, 99 % below " + us(times.percentile_ns(0.99)) +
         ", 99.9 % below " + us(times.percentile_ns(0.999)) + ", at most " + us(times.max_ns());
}

}  // namespace

std::vector<ServoRow> servo_rows(const ServoState& state) {
  const ServoStatistics& statistics = state.statistics;
  if (statistics.ticks == 0) return {};
  const RealTimeStatus& granted = state.real_time;
  const auto ticks = as_size(statistics.ticks);
  std::vector<ServoRow> rows{
      {"servo", short_number(state.rate) + " Hz, " + counted(ticks, "tick")},
      {"real time", std::string(granted.real_time_priority ? "priority granted" : "no priority granted") +
                        (granted.memory_locked ? ", memory locked" : ", memory not locked")},
      {"late", short_number(100.0 * static_cast<double>(statistics.late) / static_cast<double>(ticks)) +
                   " % by over half a period"},
      {"wakes after", spread(statistics.lateness)},
      {"overruns", std::to_string(statistics.overruns) + ", " + counted(as_size(statistics.skipped), "tick") +
                       " skipped"},
      {"update", spread(statistics.update)}};
  if (state.hand.passivity_watched) {
    constexpr double kMillijoules = 1e3;
    rows.push_back({"passivity", short_number(kMillijoules * state.hand.passivity_energy) +
                                     " mJ taken up, damped by " + short_number(state.hand.passivity_damping) +
                                     " N s/m"});
  }
  if (statistics.faults > 0) rows.push_back({"faults", std::to_string(statistics.faults)});
  if (statistics.stalls > 0) {
    rows.push_back({"stalls", std::to_string(statistics.stalls) + ", the device was stopped"});
  }
  if (statistics.stops > 0) {
    rows.push_back({"stopped", counted(as_size(statistics.stops), "time") +
                                   " by sleep or Ctrl-Z; no force until it is armed"});
  }
  return rows;
}

}  // namespace palpate
