#include "tests/extreme/hostile_hand.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace palpate::test {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr double kRounding = 1e-12;  // relative

}  // namespace

void HostileTally::add(const HostileTally& other) noexcept {
  steps += other.steps;
  at_cap += other.at_cap;
  fading += other.fading;
  for (std::size_t i = 0; i < cuts.size(); ++i) cuts[i] += other.cuts[i];
}

double HostileHand::nasty() {
  constexpr std::array kNasty{kNan,
                              kInf,
                              -kInf,
                              std::numeric_limits<double>::max(),
                              std::numeric_limits<double>::lowest(),
                              std::numeric_limits<double>::min(),
                              std::numeric_limits<double>::denorm_min(),
                              0.0,
                              -0.0,
                              1e154,
                              -1e-160};
  if (once_in(3)) return (2.0 * unit() - 1.0) * std::exp2(static_cast<double>(random_() % 2100) - 1050.0);
  return kNasty[random_() % kNasty.size()];
}

DeviceLimits HostileHand::limits() {
  DeviceLimits limits;
  limits.force_cap = once_in(6) ? 1e-3 : 0.5 + 8.0 * unit();
  limits.slew_cap = once_in(6) ? 1e6 : 20.0 + 400.0 * unit();
  if (once_in(2)) limits.velocity_gate = 0.5 + 20.0 * unit();
  limits.stale_after = once_in(4) ? kInf : 0.01 + 0.1 * unit();
  if (once_in(2)) limits.start_ramp = 0.3 * unit();
  limits.fade_time = once_in(4) ? 0.0 : 0.050 * unit();
  if (once_in(3)) limits.continuous_cap = limits.force_cap * (0.2 + 0.7 * unit());
  limits.heating_time = 0.01 + 0.5 * unit();
  if (once_in(3)) {
    limits.reach_lower = -ways_.wild * unit();
    limits.reach_upper = ways_.wild * (0.1 + unit());
    limits.edge_margin = 0.02 * unit();
    limits.edge_stiffness = once_in(4) ? 1e6 : 500.0 * unit();
  }
  if (once_in(3)) limits.enabling_button = static_cast<int>(random_() % 3);
  limits.latch_faults = once_in(3);
  EXPECT_TRUE(limits.valid());
  return limits;
}

ChainSettings HostileHand::settings() {
  ChainSettings settings;
  settings.stiffness = once_in(4) ? 1e9 * unit() : 2000.0 * unit();
  ChainSettings::each(settings, [this](std::string_view /*name*/, auto& value) {
    if constexpr (std::is_same_v<std::remove_cvref_t<decltype(value)>, double>) {
      if (once_in(4)) value *= std::exp2(6.0 * unit() - 3.0);
      if (once_in(60)) value = nasty();
    }
  });
  return settings;
}

Vec3 HostileHand::place() {
  s_ += 2e-4 * (unit() - 0.45);
  s_ -= std::floor(s_);
  aside_ += 2e-4 * Vec3{unit() - 0.5, unit() - 0.5, unit() - 0.5};
  if (once_in(400)) aside_ = 0.2 * ways_.wild * Vec3{unit() - 0.5, unit() - 0.5, unit() - 0.5};
  if (once_in(300)) aside_ = Vec3{0.0};
  if (once_in(500)) s_ = unit();
  Vec3 x = ways_.path(s_) + aside_;
  if (once_in(150)) x = ways_.wild * (2.0 * Vec3{unit(), unit(), unit()} - 1.0);
  if (once_in(300)) x[static_cast<int>(random_() % 3)] = nasty();
  if (once_in(1000)) x = Vec3{nasty(), nasty(), nasty()};
  return x;
}

HandInput HostileHand::input() {
  HandInput input;
  const bool stalled = once_in(700);
  time_ += stalled ? 0.5 * unit() : 0.001 * (0.5 + unit());
  input.time = time_;
  if (once_in(400)) input.time = nasty();
  if (once_in(500)) input.time = time_ - 0.01 * unit();
  if (once_in(20'000)) time_ += 1e9 * unit();

  if (once_in(600)) away_ = static_cast<int>(random_() % 50);
  if (once_in(600)) stuck_ = static_cast<int>(random_() % 200);
  if (once_in(400)) released_ = static_cast<int>(random_() % 80);
  input.present = away_-- <= 0;
  if (stuck_-- <= 0) last_ = {time_ - 0.002 * unit(), place(), 0};
  if (once_in(500)) last_.time = nasty();
  last_.buttons = released_-- > 0 ? static_cast<std::uint32_t>(random_()) & ~7U : 7U;
  input.sample = last_;
  return input;
}

void HostileHand::disturb(HandStepper& stepper) {
  if (once_in(150)) stepper.apply(static_cast<HandSwitch>(random_() % 3));
  if (once_in(50)) stepper.apply(HandSwitch::kArm);
  if (once_in(200)) stepper.apply(settings());
}

bool SafetyWitness::holds(const HandInput& input, const HandStep& step) {
  const double dt = started_ ? input.time - time_ : kNan;
  if (std::isfinite(input.time)) {
    time_ = input.time;
    started_ = true;
  }
  const Vec3 force = step.force, before = std::exchange(force_, step.force);
  const double length = glm::length(force), square = glm::dot(before, before);
  // What the force may fall to without anybody's leave.
  const double lambda = square > 0.0 ? std::clamp(glm::dot(force, before) / square, 0.0, 1.0) : 0.0;
  const double most = dt > 0.0 ? limits_.slew_cap * std::min(dt, SafetyStage::kLongestStep) : 0.0;
  const bool cut = step.cut != ForceCut::kNone, fades = fades_out(step.cut);

  EXPECT_TRUE(is_finite(force));
  EXPECT_LE(length, limits_.force_cap * (1.0 + kRounding));
  EXPECT_LE(glm::distance(force, lambda * before), most * (1.0 + kRounding) + 4e-15 * limits_.force_cap);
  EXPECT_TRUE(!cut || fades || force == Vec3{0.0}) << name_of(step.cut);
  EXPECT_EQ(step.state == HoldState::kFault, is_fault(step.cut) || step.chain.state == HoldState::kFault);
  EXPECT_TRUE(is_finite(step.probe));
  for (int i = 0; i < step.chain.links; ++i) {
    EXPECT_TRUE(is_finite(step.chain.proxies[static_cast<std::size_t>(i)]));
  }
  if (::testing::Test::HasFailure()) {
    ADD_FAILURE() << "at step " << step.number << ", " << name_of(step.cut) << ", dt " << dt;
    return false;
  }
  ++tally_.steps;
  tally_.at_cap += length >= 0.9 * limits_.force_cap ? 1 : 0;
  tally_.fading += fades && length > 0.0 ? 1 : 0;
  ++tally_.cuts[static_cast<std::size_t>(step.cut)];
  return true;
}

HostileTally run_hostile(const std::function<std::unique_ptr<ProxyChain>()>& make_chain, const HandWays& ways,
                         std::uint64_t seed, std::uint64_t steps) {
  constexpr std::uint64_t kEpisode = 2000;
  constexpr std::size_t kChains = 3;
  HostileTally tally;
  HostileHand hand(ways, seed);
  std::vector<std::unique_ptr<ProxyChain>> chains;
  for (std::size_t i = 0; i < kChains; ++i) chains.push_back(make_chain());
  std::size_t next = 0;
  while (tally.steps < steps) {
    const DeviceLimits limits = hand.limits();
    HandStepper stepper(std::move(chains[next]), limits);
    stepper.apply(hand.settings());
    SafetyWitness witness(limits);
    for (std::uint64_t i = 0; i < kEpisode; ++i) {
      hand.disturb(stepper);
      if (i % 700 == 699) {  // another scene
        std::unique_ptr<ProxyChain>& other = chains[(next + 1) % kChains];
        other->reset();
        other = stepper.exchange_chain(std::move(other));
      }
      const HandInput input = hand.input();
      if (!witness.holds(input, stepper.step(input))) return tally;
    }
    tally.add(witness.tally());
    chains[next] = stepper.exchange_chain(nullptr);
    chains[next]->reset();
    next = (next + 1) % kChains;
  }
  return tally;
}

}  // namespace palpate::test
