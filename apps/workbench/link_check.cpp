#include "apps/workbench/link_check.h"

#include <chrono>
#include <cmath>
#include <thread>
#include <utility>

#include "common/base/text.h"
#include "common/servo/linked_device.h"
#include "common/servo/real_time.h"
#include "common/servo/servo_loop.h"

namespace palpate {
namespace {

double seconds_of(std::int64_t ns) noexcept { return 1e-9 * static_cast<double>(ns); }
double milliseconds_of(std::uint64_t ns) noexcept { return 1e-6 * static_cast<double>(ns); }

}  // namespace

LinkCheck check_link(DriverLink& link, double seconds, double patience, Progress& progress) {
  LinkCheck check;
  const std::int64_t start = monotonic_ns();
  std::int64_t last_sample = 0, ready_since = 0;
  LinkPhase phase = link.status().phase;
  check.steps.push_back({0.0, phase});
  for (std::int64_t now = start;;) {
    progress.check();
    const bool fresh = link.round();
    const std::int64_t after = monotonic_ns();
    if (link.status().phase != phase) {
      phase = link.status().phase;
      check.steps.push_back({seconds_of(after - start), phase});
      last_sample = 0;
    }
    if (fresh && phase == LinkPhase::kReady) {
      if (ready_since == 0) ready_since = after;
      if (last_sample != 0) {
        check.intervals.add(after - last_sample);
        check.rounds.add(after - now);
        check.measured += seconds_of(after - last_sample);
      }
      last_sample = after;
    }
    now = after;
    if (ready_since != 0 ? seconds_of(now - ready_since) >= seconds : seconds_of(now - start) >= patience)
      break;
  }
  check.ready = phase == LinkPhase::kReady;
  check.status = link.status();
  check.advice = link.advice();
  check.place = link.place();
  check.tracks = link.poses() != nullptr;
  check.has_arm = link.atoms().has_position && !check.tracks;
  return check;
}

TimeHistogram force_delays(std::shared_ptr<DriverLink> link, double seconds, Progress& progress) {
  LinkedDevice device(std::move(link));
  const ServoLoop servo(device, nullptr, "");
  for (const std::int64_t start = monotonic_ns(); seconds_of(monotonic_ns() - start) < seconds;) {
    progress.check();
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  TimeHistogram delays;
  (void)device.read_delays(delays);
  return delays;
}

std::vector<std::string> advice_on(const LinkCheck& check) {
  std::vector<std::string> advice;
  if (!check.advice.empty()) advice.push_back(check.advice);
  if (check.ready && check.tracks) {
    constexpr double kSluggish = 50.0;  // [Hz] records: the slowest tracker, of one sensor, has 60
    if (check.rate() < kSluggish && check.status.rounds > 0) {
      advice.push_back(
          "it tells only " + short_number(std::round(check.rate())) +
          " poses a second: what follows hands and heads will lag; plug out sensors that are not "
          "used, and take the highest rate of its line");
    }
  }
  if (!check.ready || !check.has_arm) return advice;
  constexpr double kSlow = 400.0;  // [Hz] stiff walls buzz
  constexpr double kUneven = 5.0;  // [ms]
  if (check.rate() < kSlow && check.status.rounds > 0) {
    advice.push_back(
        "it answers only " + short_number(std::round(check.rate())) +
        " times a second: plug it in directly, without a hub, and end other programs; walls must be "
        "softer for it");
  }
  if (milliseconds_of(check.intervals.percentile_ns(0.99)) > kUneven) {
    advice.push_back(
        "samples come unevenly: allow real-time priority (a line '@audio - rtprio 95' in "
        "/etc/security/limits.d, and your user in that group)");
  }
  constexpr double kLossy = 1e-3;
  const auto lost = static_cast<double>(check.status.lost + check.status.implausible);
  if (lost > kLossy * static_cast<double>(check.status.rounds + 1)) {
    advice.push_back(counted(check.status.lost, "answer") + " lost and " +
                     std::to_string(check.status.implausible) +
                     " that made no sense: another cable or socket");
  }
  return advice;
}

std::string udev_rule(const std::string& id) {
  const std::size_t colon = id.find(':');
  return R"(SUBSYSTEM=="usb", ATTR{idVendor}==")" + id.substr(0, colon) + R"(", ATTR{idProduct}==")" +
         id.substr(colon + 1) + R"(", TAG+="uaccess")";
}

}  // namespace palpate
