/// A constraint that pulls hard at the border of a device's reach.
#pragma once

#include "common/haptics/constraint.h"

namespace palpate::test {

/// Holds the hand to one place, whatever it does: tens of newtons at the border.
class Tether final : public Constraint {
 public:
  void apply(const ChainSettings& /*settings*/) noexcept override {}
  void reset() noexcept override {}
  void update(const Vec3& /*probe*/, const UpdateBudget& /*budget*/, LinkUpdate& link) noexcept override {
    link.proxy = Vec3{0.005, -0.01, 0.002};
    link.state = HoldState::kHeld;
  }
};

}  // namespace palpate::test
