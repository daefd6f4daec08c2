/// The line that the servo follows, as it is drawn and as it is saved.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "common/geometry/line.h"
#include "common/render/line_style.h"
#include "common/render/probe_view.h"
#include "common/trace/live_line.h"

namespace palpate {

/// Follows the growth of a LiveLine and keeps what is drawn of it up to date. One thread, the live line's
/// only reader.
class FollowedCurve {
 public:
  /// @param before whose last line stays the last one until another is followed; null: none does.
  explicit FollowedCurve(std::shared_ptr<const LiveLine> live, const FollowedCurve* before = nullptr);

  /// Takes what has grown since.
  /// @param ball_interval time between stream balls [data units]; 0: none.
  /// @param style of the picture's lines: what colours them colours this one, too, but for the index of a seed,
  /// which it has none of, and for its end while that is not reached.
  void update(double ball_interval, const LineStyle& style);

  /// Null while no line is followed. Points are so close that the chords between them leave the line by no
  /// more than half a millionth of the diagonal.
  [[nodiscard]] const std::shared_ptr<const FollowedLine>& drawn() const noexcept { return drawn_; }
  /// The same, or while none is followed what was last: coloured as drawn().
  [[nodiscard]] const std::shared_ptr<const FollowedLine>& last() const noexcept { return last_; }
  /// From now on there was none.
  void forget() noexcept {
    shape_ = {};
    drawn_.reset();
    last_.reset();
    number_ = 0;
  }
  /// Changes with the line; 0 while none is followed.
  [[nodiscard]] std::uint64_t number() const noexcept { return number_; }
  /// The whole line as of the last update(), from its upstream end, data units; arc counts from there. When
  /// none is followed any more it is still the last one.
  [[nodiscard]] const Line& line() const noexcept { return line_; }

 private:
  /// A line with all that may colour it.
  struct Shape {
    std::vector<LinePoint> points, balls;
    std::optional<End> end;  ///< downstream; none while it may still grow
  };
  [[nodiscard]] bool has_grown(const GrowingLine& line, std::uint64_t number, double ball_interval);
  void take_shape(const GrowingLine& line, double ball_interval);
  [[nodiscard]] std::shared_ptr<const FollowedLine> colored(const LineStyle& style) const;

  std::shared_ptr<const LiveLine> live_;
  Shape shape_;  ///< of last_
  std::shared_ptr<const FollowedLine> drawn_, last_;
  Line line_;
  std::uint64_t number_ = 0;
  int first_node_ = 0, last_node_ = 0;
  double ball_interval_ = 0.0;
  ColorBy color_by_ = ColorBy::kSpeed;
  std::shared_ptr<const LineArray> array_;
};

}  // namespace palpate
