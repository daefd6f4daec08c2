/// Detents: places that catch softly, for the way of a slider or knob.
///
///   p = the mark m nearest to x,   kappa = notch_hold(|m - x|, w)   (notch.h)
///
/// With w at most half the distance between neighbours, the pull has faded before the nearest mark is another
/// one, so it is that of a potential and has no leap; the proxy leaps there, by nothing that is felt. Marks
/// stay where they are: J = 0.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "common/haptics/constraint.h"
#include "common/haptics/constraint/streamline.h"

namespace palpate {

class DetentMarks final : public Constraint {
 public:
  static constexpr std::size_t kMost = 128;

  /// @param marks [m], finite, one at least, kMost at most  @param reach w [m], > 0.
  /// @throws std::length_error for other numbers of marks.
  DetentMarks(std::span<const Vec3> marks, double reach);

  void apply(const ChainSettings& /*settings*/) noexcept override {}
  void reset() noexcept override {}
  void update(const Vec3& probe, const UpdateBudget& budget, LinkUpdate& link) noexcept override;

 private:
  std::array<Vec3, kMost> marks_{};
  std::size_t count_;
  double reach_;
};

// Haptic tick marks at equal times along a followed streamline (Ikits 2006, sec. 8.1): the faster the flow,
// the farther apart they are felt. A secondary constraint, after the streamline's in the chain.
//
// Its proxy sits on a mark and jumps by the snap-drag rule, in the time of the flow, so that it stays within
// one interval of the streamline's proxy.

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
