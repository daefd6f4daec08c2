#include "library/palpate/servo.h"

#include <algorithm>
#include <chrono>
#include <optional>
#include <utility>
#include <vector>

#include "common/base/index.h"
#include "common/device/mouse_device.h"
#include "common/device/probe_path.h"
#include "common/device/replay_device.h"
#include "common/device/simulated_device.h"
#include "common/servo/servo_loop.h"
#include "library/access.h"

namespace palpate::api {

struct DeviceData {
  std::optional<std::vector<PathRow>> path;  ///< none: led
  std::optional<SimulatedDeviceOptions> arm;
};

namespace {

std::vector<PathRow> rows_of(std::span<const Point> points, std::span<const double> times) {
  constexpr double kStep = 0.001;  // [s]
  if (!times.empty() && times.size() != points.size())
    throw Error(Error::Kind::kUsage, "as many times as points are expected");
  std::vector<PathRow> rows;
  for (std::size_t i = 0; i < points.size(); ++i)
    rows.push_back({times.empty() ? kStep * static_cast<double>(i) : times[i], vec_of(points[i]), 0});
  return rows;
}

SimulatedDeviceOptions arm_of(const ArmOptions& arm) {
  return guarded([&] {
    const DeviceProfile& profile =
        arm.profile.empty() ? device_profiles().front() : find_profile(arm.profile);
    SimulatedDeviceOptions options;
    options.profile = profile;
    options.hand = find_hand(arm.hand);
    options.limits = safe_limits(profile);
    return options;
  });
}

double now_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// The stricter of both.
DeviceLimits limits_of(const DeviceData& device, const ChainData& chain) {
  if (!device.arm) return chain.limits;
  DeviceLimits limits = device.arm->limits;
  limits.force_cap = std::min(limits.force_cap, chain.limits.force_cap);
  limits.slew_cap = std::min(limits.slew_cap, chain.limits.slew_cap);
  return limits;
}

}  // namespace

struct Servo::State {
  DeviceData device;
  double scale = 1.0;
  DeviceLimits of_chain;
  std::size_t links = 0;
  MouseDevice mouse;
  std::optional<ReplayDevice> path;
  std::optional<SimulatedDevice> arm;
  ServoState last;
  std::optional<ServoLoop> loop;  // last: it uses all of the above
};

Device Device::led() {
  Device device;
  device.data_ = std::make_shared<DeviceData>();
  return device;
}

Device Device::path(std::span<const Point> points, std::span<const double> times) {
  Device device;
  device.data_ = std::make_shared<DeviceData>(DeviceData{rows_of(points, times), std::nullopt});
  return device;
}

Device Device::simulated(const ArmOptions& arm) {
  Device device;
  device.data_ = std::make_shared<DeviceData>(DeviceData{std::nullopt, arm_of(arm)});
  return device;
}

Device Device::simulated(std::span<const Point> points, std::span<const double> times,
                         const ArmOptions& arm) {
  Device device;
  device.data_ = std::make_shared<DeviceData>(DeviceData{rows_of(points, times), arm_of(arm)});
  return device;
}

Servo::Servo(const Device& device, const Chain& chain, double rate) : state_(std::make_unique<State>()) {
  guarded([&] {
    const ChainData& of_chain = TouchAccess::of(chain);
    State& state = *state_;
    state.device = *device.data_;
    state.scale = of_chain.scale;
    state.of_chain = of_chain.limits;
    state.links = of_chain.links.size();
    const DeviceLimits limits = limits_of(state.device, of_chain);
    palpate::Device* hand = &state.mouse;
    if (state.device.path) hand = &state.path.emplace(samples_of(*state.device.path, state.scale), limits);
    if (state.device.arm) {
      state.device.arm->limits = limits;
      hand = &state.arm.emplace(*state.device.arm, *hand);
    }
    state.loop.emplace(*hand, TouchAccess::make(chain), "library", ServoOptions{.rate = rate});
  });
}

Servo::~Servo() = default;
Servo::Servo(Servo&&) noexcept = default;
Servo& Servo::operator=(Servo&&) noexcept = default;

void Servo::lead(const Point& x) {
  if (state_->device.path) throw Error(Error::Kind::kUsage, "the hand on this device follows a path");
  const Vec3 target = state_->scale * vec_of(x);
  if (state_->mouse.grabbed())
    state_->mouse.move(now_seconds(), target, 0);
  else
    state_->mouse.grab(now_seconds(), target, 0);
}

void Servo::let_go() { state_->mouse.let_go(); }

void Servo::set_chain(const Chain& chain) {
  const ChainData& data = TouchAccess::of(chain);
  if (data.scale != state_->scale || data.limits != state_->of_chain)
    throw Error(Error::Kind::kUsage,
                "a chain of the same scale and the same limits of the force is expected: name both");
  state_->links = data.links.size();
  guarded([&] { state_->loop->swap_chain(TouchAccess::make(chain), "library"); });
}

void Servo::arm() noexcept { state_->loop->arm(); }
void Servo::force_off() noexcept { state_->loop->force_off(); }

ServoNow Servo::now() {
  State& state = *state_;
  state.loop->collect_retired();
  (void)state.loop->read(state.last);
  const HandStep& step = state.last.hand;
  const Vec3 proxy = step.chain.links > 0 ? step.chain.proxies[as_size(step.chain.links - 1)] : step.probe;
  return {.time = step.time,
          .present = step.present,
          .probe = point_of(step.probe / state.scale),
          .proxy = point_of(proxy / state.scale),
          .force = point_of(step.force),
          .state = static_cast<std::uint8_t>(step.state),
          .armed = state.last.armed,
          .real_time = state.last.real_time.real_time_priority,
          .steps = state.last.statistics.ticks,
          .late = state.last.statistics.late,
          .skipped = state.last.statistics.skipped,
          .dropped = state.last.path_dropped};
}

Touch Servo::steps() {
  state_->loop->collect_retired();
  TouchData data{.links = state_->links};
  for (HandStep step; state_->loop->pop_step(step);) data.add(step, state_->scale);
  return TouchAccess::touch(std::move(data));
}

}  // namespace palpate::api
