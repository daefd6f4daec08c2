/// Keeps motors from growing too warm: what they may be told depends on what they were told lately (I^2 t).
///
///   T dh/dt = c^2 - h,     |c| <= sqrt(C^2 + (M^2 - C^2) max(0, 1 - h / C^2))
///
/// c the command, h its square as a motor feels it, C the largest that may last, M the largest of all, T the
/// time constant. A cold motor may do M for a while; in the long run none does more than C.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>

namespace palpate {

class MotorHeat {
 public:
  static constexpr std::size_t kMotors = 3;

  /// @pre 0 < lasting <= most, time > 0. The units of commands are the caller's.
  constexpr MotorHeat(double lasting, double most, double time) noexcept
      : lasting_(lasting), most_(most), time_(time) {}

  /// The commands were `commands` for the last `seconds`. @rt Safe.
  void add(const std::array<double, kMotors>& commands, double seconds) noexcept {
    const double part = -std::expm1(-std::max(0.0, seconds) / time_);
    for (std::size_t i = 0; i < kMotors; ++i) heat_[i] += part * (commands[i] * commands[i] - heat_[i]);
  }
  /// The factor, at most 1, that makes all `commands` ones that may be given. @rt Safe.
  [[nodiscard]] double factor(const std::array<double, kMotors>& commands) const noexcept {
    double least = 1.0;
    for (std::size_t i = 0; i < kMotors; ++i) {
      const double cold = std::max(0.0, 1.0 - heat_[i] / (lasting_ * lasting_));
      const double may = std::sqrt(lasting_ * lasting_ + (most_ * most_ - lasting_ * lasting_) * cold);
      if (std::abs(commands[i]) > may) least = std::min(least, may / std::abs(commands[i]));
    }
    return least;
  }

 private:
  double lasting_, most_, time_;
  std::array<double, kMotors> heat_{};
};

}  // namespace palpate
