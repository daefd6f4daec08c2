#include "common/device/replay_device.h"

#include <algorithm>
#include <cmath>

#include "common/base/index.h"

namespace palpate {

ReplayDevice::ReplayDevice(const std::vector<DeviceSample>& samples, const DeviceLimits& limits)
    : limits_(limits) {
  samples_.reserve(samples.size());
  for (const DeviceSample& sample : samples) {
    if (!std::isfinite(sample.time) || !is_finite(sample.position)) continue;
    if (samples_.empty() || sample.time > samples_.back().time) samples_.push_back(sample);
  }
}

bool ReplayDevice::read(double now, DeviceSample& sample) noexcept {
  if (samples_.empty()) return false;
  if (next_ == 0) {
    offset_ = now - samples_.front().time;
    next_ = 1;
  }
  const auto due =
      std::upper_bound(samples_.begin() + static_cast<std::ptrdiff_t>(next_), samples_.end(), now,
                       [this](double t, const DeviceSample& s) { return t < s.time + offset_; });
  next_ = as_size(due - samples_.begin());
  DeviceSample current = samples_[next_ - 1];
  current.time += offset_;
  if (next_ == samples_.size() && now - current.time > limits_.stale_after) return false;
  sample = current;
  return true;
}

}  // namespace palpate
