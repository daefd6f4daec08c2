/// A line being followed, one piece at a time. Each advance() does a bounded amount of work, so that a line
/// can be grown by a few pieces a tick.
#pragma once

#include <cmath>
#include <cstdint>
#include <optional>

#include "common/geometry/line.h"
#include "common/trace/line_builder.h"
#include "common/trace/walk/walk_state.h"

namespace palpate {

class LineWalk : public DensePiece {
 public:
  virtual ~LineWalk() = default;

  /// Puts the walk on a seed (frame L). False where it lies in no cell.
  [[nodiscard]] virtual bool start(const Vec3& seed) = 0;

  /// Follows the line by one piece. Returns why it ends there, if it does; has_piece() tells whether there is
  /// a (last) piece.
  [[nodiscard]] virtual std::optional<End> advance() = 0;

  /// @name Going on elsewhere: another walk of the same field, options and direction goes on with the same bits
  /// @{
  /// The cell of the grid in which the line is: of boxes x first; -1 for a formula.
  [[nodiscard]] virtual std::int64_t cell() const = 0;
  /// Whether save() may be asked for after this advance().
  [[nodiscard]] virtual bool movable() const { return true; }
  /// Of the last piece nothing but its end is kept.
  virtual void save(StateWriter& out) const = 0;
  virtual void restore(StateReader& in) = 0;
  /// @}

  /// The piece of the last advance(): at(theta) is defined on it.
  [[nodiscard]] bool has_piece() const noexcept { return has_piece_; }
  [[nodiscard]] const LinePoint& begin() const noexcept { return begin_; }
  [[nodiscard]] const LinePoint& end() const noexcept { return end_; }
  /// Unit tangent at end(); the last one known where the flow rests.
  [[nodiscard]] const Vec3& direction() const noexcept { return direction_; }
  /// Cosine of the angle between the first and the last tangent of the piece.
  [[nodiscard]] double turn_cosine() const noexcept { return turn_cosine_; }
  /// What the last advance() cost, in units of an ordinary piece, roughly: for those who ration pieces.
  [[nodiscard]] int work() const noexcept { return work_; }
  /// Pieces since start() that a method for stiff flows made.
  [[nodiscard]] std::int64_t stiff_steps() const noexcept { return stiff_steps_; }

 protected:
  LineWalk() = default;
  /// The state that all walks have.
  template <class Self, class Archive>
  static void each_common_member(Self& self, Archive& archive) {
    archive(self.begin_, self.end_, self.direction_, self.turn_cosine_, self.stiff_steps_);
  }

  LinePoint begin_, end_;
  Vec3 direction_{0.0};
  double turn_cosine_ = 1.0;
  int work_ = 1;
  std::int64_t stiff_steps_ = 0;
  bool has_piece_ = false;
};

/// Frame L.
struct WalkSettings {
  double tolerance = 1e-6;      ///< local error per arc length
  double fixed_step = 0.0;      ///< of Euler and RK4
  double rest_distance = 1e-6;  ///< how near a fixed point counts as having reached it
  double largest_step = HUGE_VAL;
};

}  // namespace palpate
