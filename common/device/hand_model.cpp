#include "common/device/hand_model.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <string>

#include "common/base/error.h"
#include "common/base/index.h"

namespace palpate {

const HandImpedance& find_hand(std::string_view name) {
  if (name == "relaxed") return kRelaxedHand;
  if (name == "firm") return kFirmHand;
  throw usage_error("unknown hand '" + std::string(name) + "'; known are relaxed, firm");
}

Operator::Operator(const OperatorSettings& settings) noexcept : settings_(settings) {
  constexpr double kLowest = 8.0, kHighest = 12.0;  // [Hz]
  std::mt19937_64 random(settings.seed);
  // Not a standard distribution: those differ between libraries.
  const auto unit = [&random] { return static_cast<double>(random() >> 11U) * 0x1p-53; };
  for (auto& axis : tremor_) {
    for (Sine& sine : axis) {
      sine.angular = 2.0 * std::numbers::pi * (kLowest + (kHighest - kLowest) * unit());
      sine.phase = 2.0 * std::numbers::pi * unit();
    }
  }
}

void Operator::place(double time, const Vec3& target) noexcept {
  memory_[0] = {time, target};
  newest_ = 0;
  count_ = 1;
  aim_ = target;
  time_ = time;
}

Vec3 Operator::follow(double time, const Vec3& target) noexcept {
  if (count_ == 0) place(time, target);
  if (time - seen(0).time >= kSpacing) {
    newest_ = (newest_ + 1) % kMemory;
    memory_[newest_] = {time, target};
    count_ = std::min(count_ + 1, kMemory);
  }
  const double dt = std::max(0.0, time - time_);
  time_ = std::max(time, time_);
  const double part = settings_.lag > 0.0 ? -std::expm1(-dt / settings_.lag) : 1.0;
  aim_ += part * (seen_at(time - settings_.reaction) - aim_);
  return aim_ + tremor_at(time);
}

/// The target that was seen at `time`, straight between those remembered; the oldest one before them.
Vec3 Operator::seen_at(double time) const noexcept {
  if (time >= seen(0).time) return seen(0).target;
  std::size_t newer = 0, older = count_ - 1;  // counted back from the newest
  if (time <= seen(older).time) return seen(older).target;
  while (older - newer > 1) {
    const std::size_t middle = newer + (older - newer) / 2;
    (seen(middle).time > time ? newer : older) = middle;
  }
  const Seen &a = seen(older), &b = seen(newer);
  return a.target + ((time - a.time) / (b.time - a.time)) * (b.target - a.target);
}

Vec3 Operator::tremor_at(double time) const noexcept {
  const double amplitude = settings_.tremor * std::sqrt(2.0 / kSines);
  Vec3 sum{0.0};
  for (int a = 0; a < 3; ++a) {
    for (const Sine& sine : tremor_[as_size(a)]) {
      sum[a] += amplitude * std::sin(sine.angular * time + sine.phase);
    }
  }
  return sum;
}

}  // namespace palpate
