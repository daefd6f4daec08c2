/// The line that the servo follows, as it is drawn and as it is saved.
#pragma once

#include <cstdint>
#include <memory>
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
  explicit FollowedCurve(std::shared_ptr<const LiveLine> live);

  /// Takes what has grown since.
  /// @param ball_interval time between stream balls [data units]; 0: none.
  /// @param color_by what the picture's lines are coloured by; speed, time, arc and error colour this one,
  /// too.
  void update(double ball_interval, ColorBy color_by);

  /// Null while no line is followed. Points are so close that the chords between them leave the line by no
  /// more than half a millionth of the diagonal.
  [[nodiscard]] const std::shared_ptr<const FollowedLine>& drawn() const noexcept { return drawn_; }
  /// Changes with the line; 0 while none is followed.
  [[nodiscard]] std::uint64_t number() const noexcept { return number_; }
  /// The whole line as of the last update(), from its upstream end, data units; arc counts from there. When
  /// none is followed any more it is still the last one.
  [[nodiscard]] const Line& line() const noexcept { return line_; }

 private:
  std::shared_ptr<const LiveLine> live_;
  std::shared_ptr<const FollowedLine> drawn_;
  Line line_;
  std::uint64_t number_ = 0;
  int first_ = 0, last_ = 0;
  double ball_interval_ = 0.0;
  ColorBy color_by_ = ColorBy::kSpeed;
};

}  // namespace palpate
