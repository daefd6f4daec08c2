#include "apps/workbench/feel_score.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/haptics/constraint/half_space.h"
#include "common/haptics/constraint/shape.h"

namespace palpate {

std::unique_ptr<ProxyChain> feel_chain(FeelEffect effect, double stiffness, double damping) {
  std::vector<std::unique_ptr<Constraint>> links;
  constexpr double kHalf = 0.5 * kFeelGrooveLength;
  switch (effect) {
    case FeelEffect::kWall:
      links.push_back(std::make_unique<HalfSpaceConstraint>(Vec3{0.0}, Vec3{0.0, 0.0, 1.0}));
      break;
    case FeelEffect::kGroove:
      links.push_back(std::make_unique<PolylineConstraint>(Vec3{-kHalf, 0.0, 0.0}, Vec3{kHalf, 0.0, 0.0}));
      break;
    case FeelEffect::kSphere:
      links.push_back(std::make_unique<SphereConstraint>(Vec3{0.0}, kFeelSphereRadius));
      break;
  }
  return std::make_unique<ProxyChain>(std::move(links),
                                      ChainSettings{.stiffness = stiffness, .damping = damping});
}

void FeelScore::add(const HandStep& step) noexcept {
  ++steps_;
  if (!step.present || is_fault(step.cut)) {
    faults_ += step.present ? 1 : 0;
    known_ = touching_ = false;
    return;
  }
  const double size = glm::length(step.force);
  largest_ = std::max(largest_, size);
  if (known_) given_ += glm::dot(last_force_, step.probe - last_probe_);
  const bool holds = step.state == HoldState::kHeld || step.state == HoldState::kFellBack;
  if (!holds) {
    free_ = std::max(free_, size);
    if (touching_) most_given_ = std::max(most_given_, given_);
    given_ = 0.0;
  } else {
    ++held_;
    const Vec3 stretch = step.chain.proxy(step.probe) - step.probe;
    const double length = glm::length(stretch);
    deepest_ = std::max(deepest_, length);
    // While it grows from zero after a start, the force says nothing of the spring.
    if (step.cut == ForceCut::kNone) {
      force_stretch_ += glm::dot(step.force, stretch);
      stretch_stretch_ += length * length;
    }
    constexpr double kLeastForce = 0.1;  // [N]: below, directions are rounding
    if (size > kLeastForce && length > 0.0) {
      const Vec3 u = stretch / length;
      leak_ = std::max(leak_, glm::length(step.force - glm::dot(step.force, u) * u) / size);
    }
  }
  touching_ = holds;
  last_probe_ = step.probe;
  last_force_ = step.force;
  known_ = true;
}

double FeelScore::haptic_stiffness() const noexcept {
  return stretch_stretch_ > 0.0 ? force_stretch_ / stretch_stretch_ : 0.0;
}

std::vector<StabilityCase> FeelScore::cases() const {
  std::vector<StabilityCase> cases;
  const auto add = [&cases](std::string name, double measured, double limit, std::string unit,
                            std::string meaning) {
    cases.push_back(
        {{std::move(name), measured, limit, measured <= limit}, std::move(unit), std::move(meaning)});
  };
  constexpr double kUnfelt = 0.05;  // [N]: a hand feels no less
  constexpr double kSofter = 0.1;   // a finger tells stiffnesses apart by some 20 %
  constexpr double kAlong = 0.02;
  add("force in free air", free_, kUnfelt, "N", "largest force while nothing holds the hand");
  if (held_ > 0) {
    add("stiffness shown", std::abs(haptic_stiffness() / stiffness_ - 1.0), kSofter, "of what is asked for",
        "force over stretch, all contacts; caps and slew limits make it softer");
    add("force along what is free", leak_, kAlong, "of the force",
        "largest part of the force that does not point at the proxy");
  }
  add("steps with a fault", static_cast<double>(faults_), 0.0, "steps",
      "hand too fast, samples too old or none");
  return cases;
}

}  // namespace palpate
