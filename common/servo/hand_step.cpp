#include "common/servo/hand_step.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace palpate {
namespace {

bool is_finite(const ChainStep& step) noexcept {
  const auto finite = [](const Vec3& x) { return palpate::is_finite(x); };
  return finite(step.force) && std::isfinite(step.residual) &&
         std::all_of(step.proxies.begin(), step.proxies.begin() + step.links, finite);
}

}  // namespace

std::unique_ptr<ProxyChain> HandStepper::exchange_chain(std::unique_ptr<ProxyChain> chain) noexcept {
  chain_.swap(chain);
  last_ = {};
  starting_ = true;
  return chain;
}

void HandStepper::apply(const ChainSettings& settings) noexcept {
  if (chain_ && settings.valid()) chain_->apply(settings);
}

void HandStepper::apply(HandSwitch change) noexcept {
  switch (change) {
    case HandSwitch::kForceOff:
      safety_.switch_off();
      break;
    case HandSwitch::kArm:
      safety_.arm();
      starting_ = true;
      break;
    case HandSwitch::kPause:
      paused_ = true;
      break;
    case HandSwitch::kResume:
      paused_ = false;
      starting_ = true;
      break;
    case HandSwitch::kRestart:
      starting_ = true;
      break;
  }
}

HandStep HandStepper::step(const HandInput& input) noexcept {
  const double dt = input.time - last_time_;
  if (std::isfinite(input.time)) last_time_ = input.time;

  ForceRequest request{.dt = dt, .cut = judge(input, dt)};
  if (request.cut == ForceCut::kNoHand) let_go();
  if (request.cut == ForceCut::kNone) {
    request.age = input.time - input.sample.time;
    request.speed = speed_to(input.sample);
    request.position = input.sample.position;
    request.buttons = input.sample.buttons;
    estimate_velocity(input.sample);
    last_sample_ = input.sample;
    last_sample_time_ = input.sample.time;
    const ChainStep now = chain_ ? chain_->step(input.sample.position, velocity_) : ChainStep{};
    if (!is_finite(now)) {
      chain_->reset();
      request.cut = ForceCut::kNotFinite;
    } else {
      last_ = now;
      request.force = now.force;
      if (now.state == HoldState::kFault) {
        request.cut = ForceCut::kChain;
      } else if (now.jumped) {
        request.cut = ForceCut::kJump;
      } else if (starting_) {
        request.cut = ForceCut::kStart;
      }
      starting_ = false;
    }
  }

  HandStep out{.number = next_++, .time = input.time, .present = input.present};
  out.force = safety_.apply(request);
  out.cut = safety_.cut();
  out.probe = last_sample_.position;
  out.buttons = last_sample_.buttons;
  out.chain = last_;
  out.state = is_fault(out.cut) ? HoldState::kFault : last_.state;
  return out;
}

ForceCut HandStepper::judge(const HandInput& input, double dt) const noexcept {
  if (paused_) return ForceCut::kPaused;
  if (!input.present) return ForceCut::kNoHand;
  const DeviceSample& sample = input.sample;
  if (!std::isfinite(input.time) || !std::isfinite(sample.time) || !is_finite(sample.position)) {
    return ForceCut::kNotFinite;
  }
  if (dt <= 0.0) return ForceCut::kTime;  // NaN on the first step, which has nothing to be later than
  if (input.time - sample.time > limits().stale_after) return ForceCut::kStale;
  return ForceCut::kNone;
}

double HandStepper::speed_to(const DeviceSample& sample) const noexcept {
  const double dt = sample.time - last_sample_time_;
  if (!(dt > 0.0)) return 0.0;  // the same sample again, or the first
  return glm::length((sample.position - last_sample_.position) / dt);
}

void HandStepper::estimate_velocity(const DeviceSample& sample) noexcept {
  constexpr double kSmoothing = 0.005;  // [s] time constant: 32 Hz
  const double dt = sample.time - last_sample_time_;
  if (!(dt > 0.0)) return;
  const Vec3 difference = (sample.position - last_sample_.position) / dt;
  velocity_ += (difference - velocity_) * (dt / (dt + kSmoothing));
  if (!is_finite(velocity_)) velocity_ = Vec3{0.0};
}

void HandStepper::let_go() noexcept {
  if (std::isnan(last_sample_time_)) return;
  last_sample_time_ = kNever;
  velocity_ = Vec3{0.0};
  last_ = {};
  starting_ = true;
  if (chain_) chain_->reset();
}

}  // namespace palpate
