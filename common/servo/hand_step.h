/// One servo step, without a thread, a clock or a device: what the hand does goes in, what it feels comes
/// out.
///
///   sanity of the sample -> ProxyChain::step -> PassivityController, EventPulse -> SafetyStage
///
/// The live loop, `probe` and a replay all step with this, so the same inputs give the same bits in all
/// three. Workspace frame, SI units.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>

#include "common/device/device.h"
#include "common/haptics/passivity.h"
#include "common/haptics/proxy_chain.h"
#include "common/haptics/velocity_estimate.h"
#include "common/servo/event_pulse.h"
#include "common/servo/hand_speed.h"
#include "common/servo/safety_stage.h"

namespace palpate {

/// What a step is made from. Nothing in it need be finite.
struct HandInput {
  double time = 0.0;     ///< [s] of the step
  bool present = false;  ///< whether a hand is on the device; if not, `sample` says nothing
  DeviceSample sample;
};

/// The result of a step.
struct HandStep {
  std::uint64_t number = 0;  ///< from 0
  double time = 0.0;         ///< [s] as given
  bool present = false;
  Vec3 probe{0.0};            ///< [m] the last finite one
  std::uint32_t buttons = 0;  ///< of the last sample that made sense
  ChainStep chain;  ///< proxies, residual, force before controller and safety stage; on a fault the last ones
  bool passivity_watched = false;      ///< whether the passivity controller is in use
  double passivity_damping = 0.0;      ///< of the passivity controller [N s/m]; 0: it had nothing to do
  double passivity_energy = 0.0;       ///< that chain and arm have taken up, as its observer has it [J]
  Vec3 force{0.0};                     ///< [N] after the safety stage
  HoldState state = HoldState::kFree;  ///< the chain's, or kFault
  ForceCut cut = ForceCut::kNone;      ///< why the force is zero, if it was made so
};

/// What can be switched between two steps.
enum class HandSwitch : std::uint8_t {
  kForceOff,  ///< no force until kArm
  kArm,       ///< force again, from zero
  kRestart    ///< the next step has no force, as after a stall
};

class HandStepper {
 public:
  /// @param chain null: nothing holds the hand. @pre limits.valid().
  HandStepper(std::unique_ptr<ProxyChain> chain, const DeviceLimits& limits) noexcept
      : chain_(std::move(chain)), safety_(limits) {}

  /// Puts another chain in place, which starts without proxies and from zero force; gives the old one back.
  [[nodiscard]] std::unique_ptr<ProxyChain> exchange_chain(std::unique_ptr<ProxyChain> chain) noexcept;
  /// Takes new settings; the force stays. Ignored where they are not valid(), or there is no chain.
  void apply(const ChainSettings& settings) noexcept;
  void apply(HandSwitch change) noexcept;

  /// @rt Safe.
  [[nodiscard]] HandStep step(const HandInput& input) noexcept;

  [[nodiscard]] std::uint64_t next_number() const noexcept { return next_; }
  [[nodiscard]] const DeviceLimits& limits() const noexcept { return safety_.limits(); }
  [[nodiscard]] bool armed() const noexcept { return safety_.armed(); }

 private:
  static constexpr double kNever = std::numeric_limits<double>::quiet_NaN();
  static constexpr double kPositionNoise = 3e-5;  ///< [m] a step of a common device's encoders

  /// What keeps the sample from being used, or kNone. @param dt [s] NaN for the first step.
  [[nodiscard]] ForceCut judge(const HandInput& input, double dt) const noexcept;
  /// Whether the passivity controller looks after a chain of so many links.
  [[nodiscard]] bool watches(int links) const noexcept;
  /// The force of the chain with the controller's damping, where that is in use. @param dt as in judge().
  [[nodiscard]] Vec3 controlled(const ChainStep& step, const Vec3& probe, double dt) noexcept;
  /// The vibration of the last event, begun where this step is one. @param force [N]
  [[nodiscard]] Vec3 pulse(const ChainStep& before, const ChainStep& now, double time,
                           const Vec3& force) noexcept;
  void let_go() noexcept;

  std::unique_ptr<ProxyChain> chain_;
  SafetyStage safety_;
  ChainStep last_;                    ///< what the chain said last
  DeviceSample last_sample_;          ///< the last one that was used
  double last_sample_time_ = kNever;  ///< [s] NaN while there is none to measure a speed from
  VelocityEstimate velocity_{kPositionNoise};
  HandSpeed speed_;
  PassivityController passivity_;
  EventPulse pulse_;
  double last_time_ = kNever;  ///< [s] the last finite time of a step
  std::uint64_t next_ = 0;
  bool starting_ = true;  ///< the next step starts from zero force
};

}  // namespace palpate
