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
#include <span>

#include "common/haptics/constraint.h"

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

}  // namespace palpate
