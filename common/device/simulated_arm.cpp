#include "common/device/simulated_arm.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/base/check.h"
#include "common/base/index.h"

namespace palpate {
namespace {

/// h, its derivative and its integral at one time.
struct Response {
  double h = 0.0;
  double slope = 1.0;     ///< h'
  double integral = 0.0;  ///< H
};

/// @pre (b/m + sqrt(k/m)) t <= 1, so that the terms fall faster than those of e.
Response response_at(const AxisLoad& load, double t) noexcept {
  const double c = load.damping / load.mass, w = load.stiffness / load.mass;
  constexpr double kNegligible = 0.125 * std::numeric_limits<double>::epsilon();
  constexpr int kMostTerms = 24;
  Response r{.h = t, .slope = 1.0, .integral = 0.5 * t * t};
  // The n-th derivative of h at 0 times t^(n-1) / n!, n = 1, 2, …: h^(n+1) = -c h^(n) - w h^(n-1).
  double before = 0.0, term = 1.0;
  for (int n = 1; n < kMostTerms; ++n) {
    const double next = -(c * t * term + w * t * t * before / n) / (n + 1);
    r.h += t * next;
    r.slope += (n + 1) * next;
    r.integral += t * t * next / (n + 2);
    before = term;
    term = next;
    if ((n + 1) * (std::abs(term) + std::abs(before)) < kNegligible) break;
  }
  return r;
}

AxisState state_at(const AxisLoad& load, const AxisState& from, double acceleration, double t) noexcept {
  const Response r = response_at(load, t);
  const double c = load.damping / load.mass;
  return {from.position + (from.velocity * (r.h + c * r.integral) + acceleration * r.integral),
          from.velocity * (r.slope + c * r.h) + acceleration * r.h};
}

/// When the velocity, which has one root in (0, t), vanishes.
double time_of_rest(const AxisLoad& load, const AxisState& from, double acceleration, double t) noexcept {
  const double w = load.stiffness / load.mass;
  double low = 0.0, high = t;
  double guess = std::clamp(-from.velocity / acceleration, low, high);  // as if it slowed down evenly
  constexpr int kMostSteps = 60;
  for (int n = 0; n < kMostSteps; ++n) {
    const double v = state_at(load, from, acceleration, guess).velocity;
    if (v == 0.0) break;
    ((v > 0.0) == (from.velocity > 0.0) ? low : high) = guess;
    const Response r = response_at(load, guess);
    const double slope = -w * from.velocity * r.h + acceleration * r.slope;
    const double newton = guess - v / slope;
    const double next = newton > low && newton < high ? newton : 0.5 * (low + high);
    if (std::abs(next - guess) <= std::numeric_limits<double>::epsilon() * t) break;
    guess = next;
  }
  return guess;
}

}  // namespace

double axis_energy(const AxisLoad& load, const AxisState& state, double rest) noexcept {
  const double stretch = state.position - rest;
  return 0.5 * (load.mass * state.velocity * state.velocity + load.stiffness * stretch * stretch);
}

AxisLoss advance_axis(const AxisLoad& load, double force, double rest, double dt, AxisState& state) noexcept {
  const double rate = load.damping / load.mass + std::sqrt(load.stiffness / load.mass);
  AxisLoss loss;
  for (double left = dt; left > 0.0;) {
    const double driving = force - load.stiffness * (state.position - rest);
    if (state.velocity == 0.0 && std::abs(driving) <= load.friction) return loss;  // sticks until a change
    const double direction = state.velocity != 0.0 ? state.velocity : driving;
    const double friction = std::copysign(load.friction, direction);
    const double acceleration = (driving - friction - load.damping * state.velocity) / load.mass;
    const double step = rate * left > 1.0 ? 1.0 / rate : left;
    const AxisState from = state;
    const double energy = axis_energy(load, from, rest);
    state = state_at(load, from, acceleration, step);
    double taken = step;
    // A step is shorter than half a period, so v has one root in it or none.
    if (load.friction > 0.0 && from.velocity != 0.0 && state.velocity * direction < 0.0) {
      taken = time_of_rest(load, from, acceleration, step);
      state = state_at(load, from, acceleration, taken);
      state.velocity = 0.0;
    }
    const double moved = state.position - from.position;
    const double rubbed = friction * moved;
    loss.friction += rubbed;
    loss.viscous += force * moved - rubbed - (axis_energy(load, state, rest) - energy);
    left -= taken;
  }
  return loss;
}

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

double SimulatedArm::stored() const noexcept {
  const Vec3 stretch = position() - rest_;
  return 0.5 * load_.stiffness * glm::dot(stretch, stretch);
}

}  // namespace palpate
