#include "common/device/simulated_device.h"

#include <cmath>
#include <numbers>

namespace palpate {

Vec3 WanderingPath::at(double time) const noexcept {
  constexpr Vec3 kPeriods{7.0, 11.3, 17.9};  // [s]
  const Vec3 turns = time / kPeriods;
  const auto wave = [](double turn) { return std::sin(2.0 * std::numbers::pi * turn); };
  return center + reach * Vec3{wave(turns.x), wave(turns.y), wave(turns.z)};
}

SimulatedDevice::SimulatedDevice(const SimulatedDeviceOptions& options, Device& leader)
    : options_(options), leader_(leader), operator_(options.operator_settings) {}

bool SimulatedDevice::read(double now, DeviceSample& sample) noexcept {
  DeviceSample led;
  if (leader_.read(now, led)) {
    target_ = led.position;
  } else if (options_.wander) {
    target_ = options_.wander->at(now);
  } else {
    return false;
  }
  if (!arm_) {
    arm_.emplace(options_.profile, options_.hand, now, target_);
    operator_.place(now, target_);
  }
  if (stopped_.exchange(false, std::memory_order_acq_rel)) arm_->stop();
  arm_->advance(now);
  arm_->set_rest(operator_.follow(now, target_));
  now_ = now;
  sample = {arm_->time(), arm_->encoders(), led.buttons};
  return true;
}

void SimulatedDevice::command(const Vec3& force) noexcept {
  if (arm_) arm_->command(now_, force);
}

}  // namespace palpate
