/// Collects a line piece by piece: output points, limits and events. Frame L inside, data units out.
///
/// A tracer hands over pieces of the curve, each with a dense output. The builder puts points at the ends of
/// the pieces (or at equal arc lengths), adds points where a piece turns, and cuts the line where it reaches
/// its length or time or crosses a stop rule.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/field/local_frame.h"
#include "common/geometry/line.h"
#include "common/trace/trace.h"
#include "common/trace/walk/walk_state.h"

namespace palpate {

/// A piece of a line in frame L; time grows along it in either direction of tracing.
class DensePiece {
 public:
  /// The point at `theta` in [0, 1]; arc and time grow with theta.
  [[nodiscard]] virtual LinePoint at(double theta) const = 0;
  /// Where `arc` is reached. @pre at(0).arc <= arc <= at(1).arc.
  [[nodiscard]] virtual double theta_at_arc(double arc) const;

 protected:
  ~DensePiece() = default;
};

/// What ends a line from outside the field, frame L.
struct LineLimits {
  double max_error = HUGE_VAL;  ///< an estimate beyond this (the domain's size) says no more than this
  double max_length = HUGE_VAL;
  double max_time = HUGE_VAL;
  double spacing = 0.0;  ///< arc between output points; 0: one at the end of each piece
  std::int64_t max_steps = 1'000'000;
  std::span<const StopRule> rules;
};

class LineBuilder {
 public:
  LineBuilder(const LocalFrame& frame, const LineLimits& limits, TraceDirection direction);

  /// Begins a line at its seed.
  void start(const LinePoint& seed);

  /// Adds a piece that ends at `end` and turns by an angle of cosine `turn_cosine` from its first to its last
  /// direction. Returns true where a limit or a rule ended the line within the piece; the line is then
  /// closed.
  [[nodiscard]] bool add(const DensePiece& piece, const LinePoint& end, double turn_cosine) {
    ++steps_;
    if (end.arc < next_event_arc_ && end.time < limits_.max_time && limits_.rules.empty() &&
        turn_cosine > kStraight && steps_ < limits_.max_steps) {
      if (limits_.spacing == 0.0) push(end);
      last_ = end;
      return false;
    }
    return add_with_events(piece, end, turn_cosine);
  }

  /// The same for a piece of which the line goes no farther than `theta`, for the reason `why`, unless a limit
  /// or a rule ends it earlier.
  void add_last(const DensePiece& piece, const LinePoint& end, double turn_cosine, double theta, End why) {
    ++steps_;
    (void)add_with_events(piece, end, turn_cosine, theta, why);
  }

  /// Closes the line where the tracer ended it.
  void finish(End end);

  /// @name A part of a line, from where it came to where it goes on
  /// @{
  /// What the next part needs.
  void save(StateWriter& out) const {
    each_member(*this, out);
    out(line_.points.back());
  }
  /// Begins a part whose first point is the last one before it. @pre no stop rules.
  void restore(StateReader& in) {
    each_member(*this, in);
    line_.points.resize(1);
    in(line_.points.front());
  }
  [[nodiscard]] std::size_t point_count() const noexcept { return line_.points.size(); }
  /// @}

  [[nodiscard]] const LinePoint& last() const noexcept { return last_; }
  [[nodiscard]] std::int64_t steps() const noexcept { return steps_; }
  /// Why the line is closed. @pre it is.
  [[nodiscard]] End why() const noexcept { return line_.end; }
  /// The line, in storage of its own size; the builder keeps its larger one for the next.
  [[nodiscard]] Line take() const { return line_; }

 private:
  template <class Self, class Archive>
  static void each_member(Self& self, Archive& archive) {
    archive(self.last_, self.next_event_arc_, self.next_output_arc_, self.steps_);
  }

  static constexpr double kStraight =
      0.97;  ///< cosine of 14 degrees: a piece that turns more gets points inside
  static constexpr double kPointAngle = 0.2;  ///< [rad] between the points inside a turning piece
  static constexpr int kMaxPointsInside = 64;

  [[nodiscard]] bool add_with_events(const DensePiece& piece, const LinePoint& end, double turn_cosine,
                                     double cut = 1.0, std::optional<End> why = std::nullopt);
  [[nodiscard]] std::optional<double> rule_crossing(const DensePiece& piece, const LinePoint& end);
  void push(const LinePoint& local) { line_.points.push_back(to_data(local)); }
  [[nodiscard]] LinePoint to_data(const LinePoint& local) const;

  const LocalFrame& frame_;
  LineLimits limits_;
  Line line_;
  LinePoint last_;
  double next_event_arc_ = 0.0;
  double next_output_arc_ = HUGE_VAL;
  double length_scale_ = 1.0, time_scale_ = 1.0, speed_scale_ = 1.0;
  std::int64_t steps_ = 0;
  std::vector<double> rule_level_;  ///< level of each rule at last_, 0 until it is first off its zero
};

}  // namespace palpate
