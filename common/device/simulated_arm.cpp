#include "common/device/simulated_arm.h"

#include <algorithm>
#include <cmath>

#include "common/base/check.h"
#include "common/base/index.h"

namespace palpate {

SimulatedArm::SimulatedArm(const DeviceProfile& profile, const HandImpedance& hand, double time,
                           const Vec3& position)
    : profile_(profile),
      load_{.mass = profile.mass + hand.mass,
            .damping = profile.damping + hand.damping,
            .stiffness = hand.stiffness,
            .friction = profile.friction},
      time_(time - profile.sensor_delay),
      rest_(position) {
  PALPATE_CHECK(profile.valid());
  for (int a = 0; a < 3; ++a) axes_[as_size(a)].position = position[a];
}

void SimulatedArm::command(double time, const Vec3& force) noexcept {
  const double length = glm::length(force);
  const Vec3 held = length <= profile_.peak_force ? force : force * (profile_.peak_force / length);
  if (pending_count_ == kMostPending) {  // a delay of more commands than these: the oldest is dropped
    first_pending_ = (first_pending_ + 1) % kMostPending;
    --pending_count_;
  }
  pending_[(first_pending_ + pending_count_) % kMostPending] = {time + profile_.actuator_delay, held};
  ++pending_count_;
}

void SimulatedArm::stop() noexcept {
  pending_count_ = 0;
  motor_ = Vec3{0.0};
}

void SimulatedArm::set_rest(const Vec3& rest) noexcept {
  const double before = stored();
  rest_ = rest;
  energy_.hand += stored() - before;
}

void SimulatedArm::advance(double time) noexcept {
  const double until = time - profile_.sensor_delay;
  time_ = std::max(time_, until - kLongestGap);
  while (time_ < until) {
    double next = until;
    if (pending_count_ > 0) {
      const Pending& first = pending_[first_pending_];
      if (first.time <= time_) {
        motor_ = first.force;
        first_pending_ = (first_pending_ + 1) % kMostPending;
        --pending_count_;
        continue;
      }
      next = std::min(next, first.time);
    }
    move(next - time_);
    time_ = next;
  }
}

void SimulatedArm::move(double dt) noexcept {
  for (int a = 0; a < 3; ++a) {
    AxisState& axis = axes_[as_size(a)];
    const double before = axis.position;
    const AxisLoss loss = advance_axis(load_, motor_[a] + push_[a], rest_[a], dt, axis);
    const double moved = axis.position - before;
    energy_.motors += motor_[a] * moved;
    energy_.pushes += push_[a] * moved;
    energy_.viscous += loss.viscous;
    energy_.friction += loss.friction;
  }
}

Vec3 SimulatedArm::position() const noexcept {
  return {axes_[0].position, axes_[1].position, axes_[2].position};
}

Vec3 SimulatedArm::velocity() const noexcept {
  return {axes_[0].velocity, axes_[1].velocity, axes_[2].velocity};
}

Vec3 SimulatedArm::encoders() const noexcept {
  const Vec3 x = position();
  const double step = profile_.encoder_step;
  if (!(step > 0.0)) return x;
  return {step * std::round(x.x / step), step * std::round(x.y / step), step * std::round(x.z / step)};
}

double SimulatedArm::kinetic() const noexcept { return 0.5 * load_.mass * glm::dot(velocity(), velocity()); }

double SimulatedArm::stored() const noexcept {
  const Vec3 stretch = position() - rest_;
  return 0.5 * load_.stiffness * glm::dot(stretch, stretch);
}

}  // namespace palpate
