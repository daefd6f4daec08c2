#include "common/servo/hand_step.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/base/index.h"

namespace palpate {
namespace {

bool is_finite(const ChainStep& step) noexcept {
  const auto finite = [](const Vec3& x) { return palpate::is_finite(x); };
  return finite(step.force) && std::isfinite(step.residual) &&
         std::all_of(step.proxies.begin(), step.proxies.begin() + step.links, finite);
}

/// [s] after a stall nothing that moves by itself leaps on by more than this.
constexpr double kLongestStep = 0.05;

}  // namespace

std::unique_ptr<ProxyChain> HandStepper::exchange_chain(std::unique_ptr<ProxyChain> chain) noexcept {
  chain_.swap(chain);
  last_ = {};
  passivity_.reset();
  pulse_.stop();
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
    case HandSwitch::kRestart:
      starting_ = true;
      break;
  }
}

HandStep HandStepper::step(const HandInput& input) noexcept {
  const double dt = input.time - last_time_;
  if (std::isfinite(input.time)) last_time_ = input.time;

  ForceRequest request{.dt = dt, .cut = judge(input, dt), .position = last_sample_.in_hand()};
  if (request.cut == ForceCut::kNoHand) let_go();
  if (request.cut == ForceCut::kNone) {
    request.age = input.time - input.sample.time;
    request.position = input.sample.in_hand();
    request.speed = speed_.update(input.sample.time, request.position);
    request.buttons = input.sample.buttons;
    const Vec3& velocity = velocity_.update(input.sample.time, input.sample.position);
    last_sample_ = input.sample;
    last_sample_time_ = input.sample.time;
    if (chain_) chain_->press(input.sample.buttons);
    if (chain_) chain_->advance(dt > 0.0 ? std::min(dt, kLongestStep) : 0.0);
    const ChainStep now = chain_ ? chain_->step(input.sample.position, velocity) : ChainStep{};
    if (!is_finite(now)) {
      chain_->reset();
      passivity_.reset();
      request.cut = ForceCut::kNotFinite;
    } else {
      const ChainStep before = std::exchange(last_, now);
      request.force = controlled(now, input.sample.position, dt);
      const Vec3 vibration = pulse(before, now, input.time, request.force);
      request.force += vibration;
      last_.active += vibration;
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
  const double asked = glm::length(request.force);
  const double let_through = asked > 0.0 ? std::min(glm::length(out.force) / asked, 1.0) : 0.0;
  passivity_.sent(out.force, let_through * last_.active);
  out.cut = safety_.cut();
  out.probe = last_sample_.position;
  out.buttons = last_sample_.buttons;
  out.chain = last_;
  out.passivity_watched = watches(last_.links);
  out.passivity_damping = passivity_.damping();
  out.passivity_energy = passivity_.energy();
  out.state = is_fault(out.cut) ? HoldState::kFault : last_.state;
  return out;
}

ForceCut HandStepper::judge(const HandInput& input, double dt) const noexcept {
  if (!input.present) return ForceCut::kNoHand;
  const DeviceSample& sample = input.sample;
  if (!std::isfinite(input.time) || !std::isfinite(sample.time) || !is_finite(sample.position) ||
      !is_finite(sample.in_hand())) {
    return ForceCut::kNotFinite;
  }
  if (dt <= 0.0) return ForceCut::kTime;  // NaN on the first step, which has nothing to be later than
  if (input.time - sample.time > limits().stale_after) return ForceCut::kStale;
  return ForceCut::kNone;
}

bool HandStepper::watches(int links) const noexcept {
  return chain_ && links >= chain_->settings().passivity.from_links;
}

Vec3 HandStepper::controlled(const ChainStep& step, const Vec3& probe, double dt) noexcept {
  if (!watches(step.links)) return step.force;
  const ChainSettings& settings = chain_->settings();
  // What the springs can hold at most: no axis is stiffer than k.
  double stored = 0.0;
  Vec3 pulled = probe;
  for (int i = 0; i < step.links; ++i) {
    const Vec3 stretch = step.proxies[as_size(i)] - pulled;
    stored += 0.5 * settings.stiffness * glm::dot(stretch, stretch);
    pulled += stretch;
  }
  const double passed = dt > 0.0 ? dt : 0.0;  // NaN on the first step
  return passivity_.control(probe, passed, step.force, stored, settings.passivity);
}

Vec3 HandStepper::pulse(const ChainStep& before, const ChainStep& now, double time,
                        const Vec3& force) noexcept {
  if (!chain_) return Vec3{0.0};
  const bool out = (before.state == HoldState::kOutside) != (now.state == HoldState::kOutside);
  const bool event = now.crossed || (now.at_end && !before.at_end) || (out && before.links > 0);
  if (event) pulse_.start(time, force);
  return pulse_.force(time, chain_->settings().events);
}

void HandStepper::let_go() noexcept {
  if (std::isnan(last_sample_time_)) return;
  last_sample_time_ = kNever;
  velocity_.reset();
  speed_.reset();
  passivity_.reset();
  pulse_.stop();
  last_ = {};
  starting_ = true;
  if (chain_) chain_->reset();
}

}  // namespace palpate
