/// A hand that follows a streamline of a flow through an arm: on an emulated device and on the simulated arm
/// of the same physics.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <vector>

#include "common/device/driver_link.h"
#include "common/device/simulated_device.h"
#include "common/field/analytic/examples.h"
#include "common/hand/mode/haptic_mode.h"
#include "common/servo/hand_step.h"
#include "tests/common/device/driver/round_with.h"
#include "tests/e2e/explorer_test.h"

namespace palpate::test {

struct Moment {
  double time = 0.0;
  Vec3 probe{0.0}, force{0.0};
};

/// How far the hand goes apart, as parts of what it moves and feels.
struct Apart {
  double probe = 0.0, force = 0.0;
  double pushed = 0.0;  ///< [N] root mean square of the force
};

class HandInFlow : public ExplorerTest {
 protected:
  static constexpr double kEnd = 12.0;   ///< [s]
  static constexpr double kHand = 80.0;  ///< [N/m] of the spring to where the hand wants to be

  HandInFlow()
      : ExplorerTest("flow"),
        field_(make_vector_field(example("abc"))),
        workspace_(Workspace::default_scale(field_->diagonal()), {}),
        middle_(workspace_.workspace_from_data(field_->bounds().center())) {
    limits_ = safe_limits(find_profile("falcon"));
    limits_.reach_lower = Vec3{-HUGE_VAL};
    limits_.reach_upper = Vec3{HUGE_VAL};
  }

  /// Where the hand wants to be, from the middle of the data [m].
  static Vec3 wanted(double time) {
    const double t = std::max(0.0, time - 1.0);
    return 0.02 * Vec3{std::sin(1.3 * t), std::sin(0.9 * t), std::sin(1.7 * t)};
  }

  /// Works `link` until kEnd. @param now of its clock. @param want tells the hand where to go.
  [[nodiscard]] std::vector<Moment> on_device(DriverLink& link, const std::function<double()>& now,
                                              const std::function<void(const Vec3&)>& want) const {
    HandStepper stepper(chain(), limits_);
    std::vector<Moment> moments;
    Vec3 force{0.0};
    while (now() < kEnd) {
      want(wanted(now()));
      if (!round_with(link, force)) continue;
      const DeviceAtoms& atoms = link.atoms();
      const HandStep step = stepper.step(
          {.time = now(), .present = true, .sample = {atoms.time, middle_ + atoms.position, atoms.buttons}});
      force = step.force;
      moments.push_back({now(), step.probe, step.force});
    }
    return moments;
  }

  [[nodiscard]] std::vector<Moment> on_simulated() const {
    SimulatedDeviceOptions options{.profile = find_profile("falcon"),
                                   .hand = {.mass = 0.0, .damping = 0.0, .stiffness = kHand},
                                   .operator_settings = {.reaction = 0.0, .lag = 0.0, .tremor = 0.0},
                                   .limits = limits_};
    Wanting leader(middle_);
    SimulatedDevice device(options, leader);
    HandStepper stepper(chain(), limits_);
    std::vector<Moment> moments;
    for (double now = 0.0; now < kEnd; now += 0.001) {
      HandInput hand{.time = now};
      hand.present = device.read(now, hand.sample);
      const HandStep step = stepper.step(hand);
      device.command(step.force);
      moments.push_back({now, step.probe, step.force});
    }
    return moments;
  }

  [[nodiscard]] Apart apart(const std::vector<Moment>& real, const std::vector<Moment>& simulated) const {
    const auto square = [](const Vec3& x) { return glm::dot(x, x); };
    double moved = 0.0, pushed = 0.0, apart = 0.0, differ = 0.0;
    int count = 0;
    for (double t = 2.0; t < kEnd - 0.01; t += 0.005, ++count) {
      const Moment &a = at(real, t), &b = at(simulated, t);
      moved += square(b.probe - middle_);
      pushed += square(b.force);
      apart += square(a.probe - b.probe);
      differ += square(a.force - b.force);
    }
    return {std::sqrt(apart / moved), std::sqrt(differ / pushed), std::sqrt(pushed / count)};
  }

 private:
  /// A leader that is where `wanted` says.
  class Wanting final : public Device {
   public:
    explicit Wanting(const Vec3& middle) : middle_(middle) {}
    bool read(double now, DeviceSample& sample) noexcept override {
      sample = {now, middle_ + wanted(now), 1U};
      return true;
    }
    void command(const Vec3& /*force*/) noexcept override {}
    void emergency_stop() noexcept override {}
    [[nodiscard]] const DeviceLimits& limits() const noexcept override { return limits_; }

   private:
    Vec3 middle_;
    DeviceLimits limits_;
  };

  /// The streamline that is felt does not let go: which of two lines holds would be a matter of rounding.
  [[nodiscard]] std::unique_ptr<ProxyChain> chain() const {
    ChainSettings settings;
    settings.stiffness = 150.0;
    settings.streamline.release_distance = 1.0;
    return modes_of(FieldKind::kVector)
        .front()
        .make({field_, workspace_, settings, 1, nullptr, nullptr})
        .chain;
  }

  /// The moment of `moments` at `time` or the one before.
  static const Moment& at(const std::vector<Moment>& moments, double time) {
    auto next = std::upper_bound(moments.begin(), moments.end(), time,
                                 [](double t, const Moment& m) { return t < m.time; });
    return next == moments.begin() ? *next : *(next - 1);
  }

  std::shared_ptr<const VectorField> field_;
  Workspace workspace_;
  Vec3 middle_;
  DeviceLimits limits_;
};

}  // namespace palpate::test
