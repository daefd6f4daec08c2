/// The streamline constraint (Ikits 2006, sec. 6.6 and 8.1): the proxy is the point of a streamline nearest
/// to the probe; stretched too far it is let go, and the line through the probe catches it.
///
/// Eqs. 6.13 and 6.14 step by v . (x - p) / |v|^2 and trace the line anew each time: that breaks down where v
/// vanishes, and diverges once the probe is farther from the line than its radius of curvature. Here the line
/// is one object (trace/growing_line.h), and on it the root of
///
///   f(s) = (c(s) - x) . c'(s),   f' = c' . c' + (c - x) . c''                                       (1)
///
/// is followed from the last proxy downhill in the distance: piece by piece until f changes sign, then by
/// safeguarded Newton in that piece. So it goes to the *local* minimum next to where it was, never to another
/// loop of the line, and it cannot leave the line, whatever the probe does.
///
/// Where it falls back: at a critical point the proxy stays on it; with the budget used up it stays where
/// the search has come to, which is on the line as well. Past the end of the data it stays at the border
/// until it is let go.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "common/haptics/constraint.h"
#include "common/haptics/workspace.h"
#include "common/trace/live_line.h"

namespace palpate {

class StreamlineConstraint final : public Constraint {
 public:
  /// @param line shared with whoever draws it; this constraint is the one that grows it.
  StreamlineConstraint(std::shared_ptr<LiveLine> line, const Workspace& workspace);

  void apply(const ChainSettings& settings) noexcept override;
  void reset() noexcept override;
  void update(const Vec3& probe, const UpdateBudget& budget, LinkUpdate& link) noexcept override;

  /// @name Where the proxy is, for constraints that follow in the chain
  /// @{

  /// The line, or null where none is followed.
  [[nodiscard]] const GrowingLine* line() const noexcept { return line_->current(); }
  [[nodiscard]] const VectorField& field() const noexcept { return line_->field(); }
  [[nodiscard]] const Workspace& workspace() const noexcept { return workspace_; }
  /// Index of the piece on which the proxy lies, and its arc length there, as of the line's nodes. @pre
  /// line().
  [[nodiscard]] int piece() const noexcept { return piece_; }
  [[nodiscard]] double arc() const noexcept { return arc_; }
  /// Counts the lines that were caught: a new one has another meaning of arc and time.
  [[nodiscard]] std::uint64_t catches() const noexcept { return catches_; }
  /// @}

 private:
  using Side = GrowingLine::Side;

  [[nodiscard]] bool catch_at(const Vec3& x, const UpdateBudget& budget, LinkUpdate& link) noexcept;
  void grow(const Vec3& x, const UpdateBudget& budget, LinkUpdate& link) noexcept;
  void go_on() noexcept;
  void search(const Vec3& x, const UpdateBudget& budget, LinkUpdate& link) noexcept;
  void settle_in(const Vec3& x, double low, double high, const UpdateBudget& budget,
                 LinkUpdate& link) noexcept;
  void describe(const Vec3& x, LinkUpdate& link) const noexcept;
  [[nodiscard]] double pace(const Vec3& x) const noexcept;
  [[nodiscard]] double room(Side side) const noexcept;
  [[nodiscard]] double look_ahead() const noexcept;
  void fit() noexcept;
  [[nodiscard]] Vec3 point() const noexcept;
  [[nodiscard]] Vec3 tangent() const noexcept;

  std::shared_ptr<LiveLine> line_;
  Workspace workspace_;
  double release_ = 0.0;      ///< frame L
  double speed_force_ = 0.0;  ///< [N] at the highest speed
  double local_max_speed_ = 1.0;
  double resolution_ = 0.0;  ///< frame L: displacements below this are rounding
  int debt_ = 0;  ///< cells grown beyond the budget of steps before: a piece in a stiff cell costs many
  int piece_ = 0;
  double arc_ = 0.0;
  std::uint64_t catches_ = 0;
};

}  // namespace palpate
