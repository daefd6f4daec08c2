/// Time along a growing line, between its nodes: the cubic of the times and of the slopes 1/speed there, or
/// the straight line where that cubic would not be monotone (Fritsch and Carlson 1980).
#pragma once

#include "common/trace/growing_line.h"

namespace palpate {

/// Time at `arc` on `piece`. @pre first() <= piece < last(), arc between its nodes.
[[nodiscard]] double time_at(const GrowingLine& line, int piece, double arc) noexcept;

struct TimePlace {
  bool found = false;
  int piece = 0;
  double arc = 0.0;
  int pieces = 0;  ///< passed on the way
};

/// Where `time` is reached, searched from `piece` over at most `max_pieces` pieces.
[[nodiscard]] TimePlace find_time(const GrowingLine& line, int piece, double time, int max_pieces) noexcept;

}  // namespace palpate
