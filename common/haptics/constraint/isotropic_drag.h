/// A point that is dragged along: the probe pulls its proxy behind it at a distance of tau, the same in all
/// directions. It steadies the hand and keeps the probe where it was let go (Ikits 2006, sec. 7.1).
#pragma once

#include "common/haptics/constraint.h"

namespace palpate {

class IsotropicDrag final : public Constraint {
 public:
  void apply(const ChainSettings& settings) noexcept override { tau_ = settings.drag.threshold; }
  void reset() noexcept override { caught_ = false; }
  void update(const Vec3& probe, const UpdateBudget& budget, LinkUpdate& link) noexcept override;

 private:
  double tau_ = 0.0;
  Vec3 proxy_{0.0};
  bool caught_ = false;
};

}  // namespace palpate
