/// A recorded force, played back over time: the hand is shown what another hand felt. The proxy is the probe.
///
///   f(t) = between the rows of a table, linearly; nothing before its first and after its last one
///
/// t counts from the first step, and from anew after a hand that let go has come back. It drives the hand, whatever that
/// does: the safety stage's cap and slew limit are what holds it.
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "common/haptics/constraint.h"

namespace palpate {

struct TimedForce {
  double time = 0.0;  ///< [s]
  Vec3 force{0.0};    ///< [N]
};

class ForcePlayback final : public Constraint {
 public:
  /// @param rows not null, two at least, finite, their times rising.
  explicit ForcePlayback(std::shared_ptr<const std::vector<TimedForce>> rows) : rows_(std::move(rows)) {}

  void apply(const ChainSettings& /*settings*/) noexcept override {}
  void reset() noexcept override { passed_ = 0.0; }
  void advance(double seconds) noexcept override { passed_ += seconds; }
  void update(const Vec3& probe, const UpdateBudget& budget, LinkUpdate& link) noexcept override;

 private:
  std::shared_ptr<const std::vector<TimedForce>> rows_;
  double passed_ = 0.0;  ///< [s]
};

}  // namespace palpate
