/// An arm in a hand, for emulators of devices that give their position as it is: mass, damping and friction
/// on each axis, a spring to where the hand wants to be, in frame D.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/math/vec.h"

namespace palpate::test {

struct ArmInHandSettings {
  double mass = 0.6;      ///< [kg] arm and hand
  double damping = 3.0;   ///< [N s/m]
  double friction = 0.7;  ///< [N] on each axis
  double hand = 80.0;     ///< [N/m]
  double end = 0.09;      ///< [m] from the middle to the stop of each axis
};

class ArmInHand {
 public:
  explicit ArmInHand(const ArmInHandSettings& settings = {}) : settings_(settings) {}

  void set_target(const Vec3& target) { target_ = target; }
  /// Of the motors, from now on.
  void push(const Vec3& force) {
    force_ = force;
    largest_ = std::max(largest_, glm::length(force));
  }
  void put(const Vec3& position) {
    x_ = position;
    v_ = Vec3{0.0};
  }
  void advance(double now) {
    constexpr double kLongest = 1e-4;  // [s]
    while (time_ < now) {
      const double dt = std::min(kLongest, now - time_);
      move(dt);
      time_ = dt < kLongest ? now : time_ + dt;
    }
  }

  [[nodiscard]] const Vec3& position() const { return x_; }
  [[nodiscard]] const Vec3& velocity() const { return v_; }
  [[nodiscard]] const Vec3& force() const { return force_; }
  [[nodiscard]] double largest_force() const { return largest_; }  ///< [N] so far
  [[nodiscard]] double time() const { return time_; }

 private:
  void move(double dt) {
    for (int a = 0; a < 3; ++a) {
      const double driving = force_[a] + settings_.hand * (target_[a] - x_[a]) - settings_.damping * v_[a];
      // Friction stops what it can stop within the step, and slows down the rest.
      const double free = v_[a] + dt * driving / settings_.mass;
      const double rubbed = dt * settings_.friction / settings_.mass;
      v_[a] = std::abs(free) <= rubbed ? 0.0 : free - std::copysign(rubbed, free);
      x_[a] += dt * v_[a];
      if (std::abs(x_[a]) > settings_.end) {
        x_[a] = std::copysign(settings_.end, x_[a]);
        v_[a] = 0.0;
      }
    }
  }

  ArmInHandSettings settings_;
  double time_ = 0.0;
  Vec3 x_{0.0}, v_{0.0}, target_{0.0}, force_{0.0};
  double largest_ = 0.0;
};

/// Every force that a device is told: by how much one grows or turns more than a slew limit allows.
class ForceWitness {
 public:
  explicit ForceWitness(double slew = 200.0) : slew_(slew) {}

  void told(double now, const Vec3& force) {
    // Falling is free.
    const double square = glm::dot(force_, force_);
    const double left = square > 0.0 ? std::clamp(glm::dot(force, force_) / square, 0.0, 1.0) : 0.0;
    excess_ = std::max(excess_, glm::distance(force, left * force_) - slew_ * (now - time_));
    largest_ = std::max(largest_, glm::length(force));
    time_ = now;
    force_ = force;
  }
  [[nodiscard]] double excess() const { return excess_; }    ///< [N] the most so far
  [[nodiscard]] double largest() const { return largest_; }  ///< [N] so far

 private:
  double slew_;  ///< [N/s]
  double time_ = 0.0, excess_ = 0.0, largest_ = 0.0;
  Vec3 force_{0.0};
};

/// Where a hand that wanders by itself wants to be after `t` seconds.
inline Vec3 wandering(double t) {
  const auto wave = [t](double period) { return std::sin(2.0 * std::numbers::pi * t / period); };
  return 0.03 * Vec3{wave(3.0), wave(4.1), wave(5.3)};
}

}  // namespace palpate::test
