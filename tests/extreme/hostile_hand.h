/// A hand, a device and a user who do whatever they can to make a servo hurt somebody, and a witness who
/// holds every force to what the safety stage promises (servo/safety_stage.h). Same seed, same run.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <random>
#include <utility>

#include "common/servo/hand_step.h"

namespace palpate::test {

/// Where an ordinary hand goes, s from 0 to 1, and the box about the origin in which a hostile one jumps [m].
struct HandWays {
  std::function<Vec3(double s)> path;
  Vec3 wild{0.2};
};

/// What all hands of a program have gone through.
struct HostileTally {
  std::uint64_t steps = 0;
  std::uint64_t at_cap = 0;  ///< forces of nine tenths of the cap or more
  std::uint64_t fading = 0;  ///< forces that fade out
  std::array<std::uint64_t, kForceCutCount> cuts{};

  void add(const HostileTally& other) noexcept;
};

class HostileHand {
 public:
  HostileHand(HandWays ways, std::uint64_t seed) : ways_(std::move(ways)), random_(seed) {}

  /// Limits that are valid, each sometimes extreme.
  [[nodiscard]] DeviceLimits limits();
  /// Settings that may be anything, valid() or not.
  [[nodiscard]] ChainSettings settings();
  /// The next input: mostly an ordinary hand, so that forces have time to grow between the attacks.
  [[nodiscard]] HandInput input();
  /// What the user does before the step, mostly nothing.
  void disturb(HandStepper& stepper);

 private:
  [[nodiscard]] bool once_in(unsigned count) { return random_() % count == 0; }
  [[nodiscard]] double unit() { return static_cast<double>(random_() >> 11U) * 0x1p-53; }
  /// Anything that a double can be.
  [[nodiscard]] double nasty();
  [[nodiscard]] Vec3 place();

  HandWays ways_;
  std::mt19937_64 random_;
  double time_ = 0.0, s_ = 0.0;
  int away_ = 0, stuck_ = 0, released_ = 0;  ///< steps for which that goes on
  Vec3 aside_{0.0};
  DeviceSample last_;
};

/// Holds the steps of a stepper to the promises. Fails the running test where one is broken.
class SafetyWitness {
 public:
  explicit SafetyWitness(const DeviceLimits& limits) : limits_(limits) {}

  /// @return false after a failure, which has been reported.
  bool holds(const HandInput& input, const HandStep& step);
  [[nodiscard]] const HostileTally& tally() const noexcept { return tally_; }

 private:
  DeviceLimits limits_;
  Vec3 force_{0.0};
  double time_ = 0.0;
  bool started_ = false;
  HostileTally tally_;
};

/// Steps a chain of `make_chain` at least `steps` times, in episodes with limits of their own.
/// @param make_chain called for each of a few chains, which take turns.
[[nodiscard]] HostileTally run_hostile(const std::function<std::unique_ptr<ProxyChain>()>& make_chain,
                                       const HandWays& ways, std::uint64_t seed, std::uint64_t steps);

}  // namespace palpate::test
