/// Haptic tick marks at equal times along a followed streamline (Ikits 2006, sec. 8.1): the faster the flow,
/// the farther apart they are felt. A secondary constraint, after the streamline's in the chain.
///
/// Its proxy sits on a mark and jumps by the snap-drag rule, in the time of the flow, so that it stays within
/// one interval of the streamline's proxy.
#pragma once

#include <cstdint>

#include "common/haptics/constraint/streamline.h"

namespace palpate {

class TickMarks final : public Constraint {
 public:
  /// @pre `streamline` stands before this in the chain and outlives it.
  explicit TickMarks(const StreamlineConstraint& streamline) : streamline_(streamline) {}

  void apply(const ChainSettings& settings) noexcept override;
  void reset() noexcept override { line_ = 0; }
  void update(const Vec3& probe, const UpdateBudget& budget, LinkUpdate& link) noexcept override;

 private:
  const StreamlineConstraint& streamline_;
  double interval_ = 0.0;  ///< local time; 0: no marks
  double kappa_ = 0.0;
  double mark_ = 0.0;       ///< time of the mark that the proxy sits on
  std::uint64_t line_ = 0;  ///< the catch that mark_ belongs to
};

}  // namespace palpate
