#include "common/device/mouse_device.h"

#include <algorithm>
#include <cmath>

namespace palpate {

void MouseDevice::grab(double time, const Vec3& position, std::uint32_t buttons) noexcept {
  newest_ = {position, time, buttons, newest_.grabs + 1, true};
  targets_.write(newest_);
}

void MouseDevice::move(double time, const Vec3& target, std::uint32_t buttons) noexcept {
  if (!newest_.grabbed) return;
  newest_.position = target;
  newest_.time = time;
  newest_.buttons = buttons;
  targets_.write(newest_);
}

void MouseDevice::let_go() noexcept {
  newest_.grabbed = false;
  targets_.write(newest_);
}

bool MouseDevice::read(double now, DeviceSample& sample) noexcept {
  Target fresh;
  bool anew = false;
  if (targets_.read(fresh)) {
    anew = target_.grabbed && fresh.grabs != target_.grabs;
    if (fresh.grabs != target_.grabs) {
      start_ = fresh.position;
      interval_ = kShortest;
    } else {
      start_ = position_at(now);
      interval_ = std::clamp(fresh.time - target_.time, kShortest, kLongest);
    }
    start_time_ = now;
    target_ = fresh;
  }
  if (!target_.grabbed || anew) return false;
  sample = {now, position_at(now), target_.buttons};  // a mouse at rest is no stale one
  return true;
}

Vec3 MouseDevice::position_at(double now) const noexcept {
  const double part = (now - start_time_) / interval_;
  if (part >= 1.0) return target_.position;
  const auto axis = [&](int a) { return std::lerp(start_[a], target_.position[a], part); };  // monotone
  return {axis(0), axis(1), axis(2)};
}

}  // namespace palpate
