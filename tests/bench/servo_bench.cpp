// The servo beside a bare timer loop: how often both wake late, and what an update costs.
//
//   servo_bench [--seconds N] [--rate HZ] [--record FILE] [--plain]
//
// Both loops run at the same time, on the same clock, with the same priority and the same absolute deadlines
// (half a period apart), for a minute unless told otherwise; the bare one does nothing but sleep and count.
// The servo does what it does in a program: a mouse that is moved 60 times a second, a chain of one
// constraint, the safety stage, publishing, and a recording where --record is given. --plain leaves both
// without real-time priority. Counts of late ticks (woken more than half a period after the deadline) belong
// to the machine as much as to the loop: only their ratio is worth comparing.

#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <thread>

#include "common/base/error.h"
#include "common/base/version.h"
#include "common/device/mouse_device.h"
#include "common/servo/servo_loop.h"
#include "tests/common/servo/sphere_drag.h"

namespace palpate::bench {
namespace {

struct BareStatistics {
  std::uint64_t ticks = 0;
  std::uint64_t late = 0;
  std::uint64_t skipped = 0;
  TimeHistogram lateness;
};

void bare_loop(const std::stop_token& stop, std::int64_t period, bool real_time, BareStatistics& result) {
  if (real_time) request_real_time_priority(80);
  for (std::int64_t due = monotonic_ns() + period / 2; !stop.stop_requested();) {
    sleep_until_ns(due);
    const std::int64_t woken = monotonic_ns();
    ++result.ticks;
    result.late += 2 * (woken - due) > period ? 1 : 0;
    result.lateness.add(woken - due);
    due += period;
    for (const std::int64_t now = monotonic_ns(); due <= now; due += period) ++result.skipped;
  }
}

double microseconds(std::uint64_t ns) { return 1e-3 * static_cast<double>(ns); }

void print(const char* name, const TimeHistogram& times) {
  std::printf("  %-22s p50 %8.2f   p99 %8.2f   p99.9 %8.2f   max %9.2f us\n", name,
              microseconds(times.percentile_ns(0.5)), microseconds(times.percentile_ns(0.99)),
              microseconds(times.percentile_ns(0.999)), microseconds(times.max_ns()));
}

double ratio(std::uint64_t a, std::uint64_t b) {
  return b > 0 ? static_cast<double>(a) / static_cast<double>(b) : std::nan("");
}

void run(double seconds, const ServoOptions& options, const char* record) {
  MouseDevice mouse;
  std::optional<Recorder> recorder;
  if (record != nullptr) recorder.emplace(record, RecordingHeader{.program = "servo_bench"}, true);
  BareStatistics bare;
  ServoState state;
  {
    std::jthread beside([&](const std::stop_token& stop) {
      bare_loop(stop, std::llround(1e9 / options.rate), options.real_time, bare);
    });
    ServoLoop servo(mouse, test::sphere_chain(0.05), "0.05", options, recorder ? &*recorder : nullptr);
    mouse.grab(0.0, {0.0, 0.0, 0.052}, 0);
    for (double t = 0.0; t < seconds; t += 1.0 / 60.0) {
      mouse.move(t, {0.02 * std::sin(3.0 * t), 0.02 * std::cos(2.0 * t), 0.048}, 0);
      for (HandStep step; servo.pop_step(step);) {
      }
      std::this_thread::sleep_for(std::chrono::microseconds(16'667));
      (void)servo.read(state);
    }
  }
  if (recorder) recorder->finish();

  const ServoStatistics& servo = state.statistics;
  std::printf("%s, %.0f Hz, %.0f s, real-time priority %s, memory locked %s\n", build_text().c_str(),
              options.rate, seconds, state.real_time.real_time_priority ? "yes" : "no",
              state.real_time.memory_locked ? "yes" : "no");
  std::printf("  %-22s %10s %10s %8s\n", "", "servo", "bare", "ratio");
  std::printf("  %-22s %10llu %10llu %8.2f\n", "ticks", static_cast<unsigned long long>(servo.ticks),
              static_cast<unsigned long long>(bare.ticks), ratio(servo.ticks, bare.ticks));
  std::printf("  %-22s %10llu %10llu %8.2f\n", "late", static_cast<unsigned long long>(servo.late),
              static_cast<unsigned long long>(bare.late), ratio(servo.late, bare.late));
  std::printf("  %-22s %10llu %10llu %8.2f\n", "skipped", static_cast<unsigned long long>(servo.skipped),
              static_cast<unsigned long long>(bare.skipped), ratio(servo.skipped, bare.skipped));
  print("lateness, servo", servo.lateness);
  print("lateness, bare", bare.lateness);
  for (const double p : {0.5, 0.99, 0.999}) {
    std::printf("  %-18s %3g %8.2f\n", "lateness ratio, p", 100.0 * p,
                ratio(servo.lateness.percentile_ns(p), bare.lateness.percentile_ns(p)));
  }
  print("update, processor time", servo.update);
  std::printf("  watchdog stalls %llu, steps nobody drained %llu, entries the recorder lost %llu\n",
              static_cast<unsigned long long>(servo.stalls),
              static_cast<unsigned long long>(state.path_dropped),
              static_cast<unsigned long long>(recorder ? recorder->lost() : 0));
}

}  // namespace
}  // namespace palpate::bench

int main(int argc, char** argv) {
  double seconds = 60.0;
  palpate::ServoOptions options;
  const char* record = nullptr;
  for (int i = 1; i < argc; ++i) {
    if (std::strcmp(argv[i], "--plain") == 0) options.real_time = false;
    if (i + 1 == argc) continue;
    if (std::strcmp(argv[i], "--seconds") == 0) seconds = std::atof(argv[i + 1]);
    if (std::strcmp(argv[i], "--rate") == 0) options.rate = std::atof(argv[i + 1]);
    if (std::strcmp(argv[i], "--record") == 0) record = argv[i + 1];
  }
  try {
    palpate::bench::run(seconds, options, record);
  } catch (const palpate::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return static_cast<int>(error.code());
  }
  return 0;
}
