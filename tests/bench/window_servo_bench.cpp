// A minute of following a streamline in flow's window, beside a bare timer loop in the same process: does the
// picture make the servo late?
//
//   xvfb-run -a window_servo_bench [--runs N] [--seconds N] [--example NAME] [--device D] [--still]
//
// The window is that of `flow`, at 60 frames a second where it can; the mouse holds the probe and goes about
// slowly in a circle, so that the line is followed, popped over and drawn anew. All loops run at the same
// rate, on the same clock, with the same priority where it is granted. --device
// simulated[:NAME][,hand=H] puts an arm and a hand between mouse and probe, as flow does. --still leaves the
// probe alone: then the picture rests, and the machine is as idle as it gets (a simulated hand wanders).
//
// A late tick (woken more than half a period after its deadline) comes from a processor that was taken away
// for a while, by the system or by a host below it, and it strikes one core at a time, dozens of ticks in a
// row. So a bare loop sits on each core, the servo is compared with their mean, and the runs are pooled; the
// spread of the ratio is that of leaving out one run after the other (jackknife: Efron and Tibshirani 1993,
// ch. 11).

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <thread>
#include <vector>

#include <sched.h>

#include "apps/flow/flow_model.h"
#include "common/base/error.h"
#include "common/base/version.h"
#include "common/cli/simulated_option.h"
#include "common/hand/mode/haptic_mode.h"
#include "common/window/window.h"

namespace palpate::bench {
namespace {

constexpr std::int64_t kPeriod = 1'000'000;  // [ns]
constexpr double kFrameRate = 60.0;

struct BareStatistics {
  std::uint64_t ticks = 0;
  std::uint64_t late = 0;
  std::uint64_t skipped = 0;
  TimeHistogram lateness;
};

void bare_loop(const std::stop_token& stop, unsigned core, BareStatistics& result) {
  cpu_set_t cores;
  CPU_ZERO(&cores);
  CPU_SET(core, &cores);
  sched_setaffinity(0, sizeof cores, &cores);
  request_real_time_priority(80);
  for (std::int64_t due = monotonic_ns() + kPeriod / 2; !stop.stop_requested();) {
    sleep_until_ns(due);
    const std::int64_t woken = monotonic_ns();
    ++result.ticks;
    result.late += 2 * (woken - due) > kPeriod ? 1 : 0;
    result.lateness.add(woken - due);
    due += kPeriod;
    for (const std::int64_t now = monotonic_ns(); due <= now; due += kPeriod) ++result.skipped;
  }
}

/// Grabs the probe in the middle of the picture and leads it about there, once in eight seconds.
std::vector<ScriptedEvent> circling(int frames, double x, double y) {
  constexpr double kRadius = 60.0, kTurn = 8.0;
  constexpr int kGrabAt = 10;
  std::vector<ScriptedEvent> script;
  script.push_back({kGrabAt - 1, {.kind = InputKind::kMove, .x = x, .y = y}});
  script.push_back({kGrabAt, {.kind = InputKind::kKeyDown, .key = 'G'}});
  for (int frame = kGrabAt + 1; frame < frames; ++frame) {
    const double angle = 6.283185307179586 * (frame - kGrabAt) / (kTurn * kFrameRate);
    script.push_back({frame,
                      {.kind = InputKind::kMove,
                       .x = x + kRadius * std::sin(angle),
                       .y = y + kRadius * (1.0 - std::cos(angle))}});
  }
  return script;
}

double microseconds(std::uint64_t ns) { return 1e-3 * static_cast<double>(ns); }
double part_of(std::uint64_t part, std::uint64_t whole) {
  return whole > 0 ? static_cast<double>(part) / static_cast<double>(whole) : 0.0;
}

void print(const char* name, const TimeHistogram& times) {
  std::printf("  %-22s p50 %8.2f   p99 %8.2f   p99.9 %8.2f   max %9.2f us\n", name,
              microseconds(times.percentile_ns(0.5)), microseconds(times.percentile_ns(0.99)),
              microseconds(times.percentile_ns(0.999)), microseconds(times.max_ns()));
}

/// Late ticks of one run.
struct LateCounts {
  double servo = 0.0, bare = 0.0;  ///< parts of the ticks
};

struct Setup {
  double seconds = 60.0;
  std::string example = "tornado";
  std::string device = "mouse";
  bool still = false;
};

LateCounts run(const Setup& setup) {
  const double seconds = setup.seconds;
  Document options;
  options.input.example = setup.example;
  FlowModel model(options, "flow");
  WindowOptions window{.program = "flow"};
  window.panels = flow_panels();
  window.touch.modes = modes_of(FieldKind::kVector);
  window.frames = static_cast<int>(seconds * kFrameRate);
  window.touch.simulated = simulated_option(setup.device);
  if (!setup.still) window.script = circling(window.frames, 860.0, 400.0);
  std::vector<double> gaps;  // between frames [ms]
  auto due = std::chrono::steady_clock::now(), before = due;
  const auto end = due + std::chrono::duration<double>(seconds);
  window.stop_requested = [&] {
    // As a display that is refreshed at this rate does it; a late frame is not made up for.
    constexpr auto kFrame = std::chrono::nanoseconds(static_cast<std::int64_t>(1e9 / kFrameRate));
    due = std::max(due + kFrame, std::chrono::steady_clock::now());
    std::this_thread::sleep_until(due);
    const auto now = std::chrono::steady_clock::now();
    gaps.push_back(std::chrono::duration<double, std::milli>(now - before).count());
    before = now;
    return now >= end;
  };
  const unsigned cores = std::thread::hardware_concurrency();
  std::vector<BareStatistics> bare(cores);
  WindowResult result;
  {
    std::vector<std::jthread> beside;
    for (unsigned core = 0; core < cores; ++core) {
      beside.emplace_back([&, core](const std::stop_token& stop) { bare_loop(stop, core, bare[core]); });
    }
    result = run_window(model, window);
  }
  const ServoState& state = result.probe.servo;
  const ServoStatistics& servo = state.statistics;
  std::printf("%s, %s, %d frames, real-time priority %s, memory locked %s, on %u cores\n",
              build_text().c_str(), (setup.example + ", " + setup.device).c_str(), result.frames,
              state.real_time.real_time_priority ? "yes" : "no", state.real_time.memory_locked ? "yes" : "no",
              cores);
  LateCounts late{.servo = part_of(servo.late, servo.ticks)};
  std::printf("  %-18s %8s %8s %8s\n", "", "ticks", "late", "skipped");
  const auto row = [](const char* name, const auto& loop) {
    std::printf("  %-18s %8llu %8llu %8llu\n", name, static_cast<unsigned long long>(loop.ticks),
                static_cast<unsigned long long>(loop.late), static_cast<unsigned long long>(loop.skipped));
  };
  row("servo", servo);
  for (const BareStatistics& loop : bare) {
    row("bare", loop);
    late.bare += part_of(loop.late, loop.ticks) / cores;
  }
  print("lateness, servo", servo.lateness);
  for (const BareStatistics& loop : bare) print("lateness, bare", loop.lateness);
  print("update, processor time", servo.update);
  std::sort(gaps.begin(), gaps.end());
  const auto part = [&](double p) {
    return gaps[static_cast<std::size_t>(p * static_cast<double>(gaps.size() - 1))];
  };
  std::printf("  between frames         p50 %8.2f   p99 %8.2f   max %8.2f ms\n", part(0.5), part(0.99),
              part(1.0));
  std::printf("  watchdog stalls %llu, steps nobody drained %llu, probe %s\n",
              static_cast<unsigned long long>(servo.stalls),
              static_cast<unsigned long long>(state.path_dropped),
              result.probe.held ? "held to the end" : "not held");
  std::fflush(stdout);
  return late;
}

/// The ratio of the sums over all runs but `left_out` (none where it is their number).
double ratio_without(const std::vector<LateCounts>& runs, std::size_t left_out) {
  LateCounts sum;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    if (i == left_out) continue;
    sum.servo += runs[i].servo;
    sum.bare += runs[i].bare;
  }
  return sum.servo / sum.bare;
}

void print_ratio(const std::vector<LateCounts>& runs) {
  const auto n = static_cast<double>(runs.size());
  double mean = 0.0, spread = 0.0;
  for (std::size_t i = 0; i < runs.size(); ++i) mean += ratio_without(runs, i) / n;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const double off = ratio_without(runs, i) - mean;
    spread += off * off;
  }
  std::printf("late ticks, servo over bare: %.3f", ratio_without(runs, runs.size()));
  if (runs.size() > 1) std::printf(" +- %.3f over %zu runs", std::sqrt(spread * (n - 1.0) / n), runs.size());
  std::printf("\n");
}

}  // namespace
}  // namespace palpate::bench

int main(int argc, char** argv) {
  palpate::bench::Setup setup;
  int runs = 1;
  for (int i = 1; i < argc; ++i) {
    if (std::strcmp(argv[i], "--still") == 0) setup.still = true;
    if (i + 1 == argc) continue;
    if (std::strcmp(argv[i], "--seconds") == 0) setup.seconds = std::atof(argv[i + 1]);
    if (std::strcmp(argv[i], "--runs") == 0) runs = std::atoi(argv[i + 1]);
    if (std::strcmp(argv[i], "--example") == 0) setup.example = argv[i + 1];
    if (std::strcmp(argv[i], "--device") == 0) setup.device = argv[i + 1];
  }
  try {
    std::vector<palpate::bench::LateCounts> late;
    while (static_cast<int>(late.size()) < runs) {
      late.push_back(palpate::bench::run(setup));
    }
    palpate::bench::print_ratio(late);
  } catch (const palpate::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return static_cast<int>(error.code());
  }
  return 0;
}
