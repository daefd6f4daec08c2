/// How far lines lie from reference lines.
///
/// Two lines of one seed and direction are compared at equal arc lengths s = k S and at their ends:
///
///   e = max_k |x(k S) - y(k S)|,  and |x(end) - y(end)| where both end for the same reason       (1)
///
/// Equal arc length is stricter than the distance between curves: being late on the right curve counts. Lines
/// that run into a sink or close on themselves are left out and counted: there, equal arc length compares
/// where two programs gave up. Lines that end for different reasons are compared up to the shorter one and
/// counted.
#pragma once

#include <cstddef>
#include <span>

#include "common/geometry/line.h"

namespace palpate {

struct LineComparison {
  double median = 0.0;  ///< of (1) over the lines, divided by the diagonal; NaN where nothing was compared
  double p95 = 0.0;     ///< 95 % of the lines lie below
  double max = 0.0;
  std::size_t compared = 0;
  std::size_t sinks = 0;           ///< either line ends inside: left out
  std::size_t different_ends = 0;  ///< compared, but not at their ends
  double stated = 0.0;             ///< the 95 % quantile of what the compared lines state as their own error
  double covered = 0.0;            ///< the part of the compared lines whose error is at most what they state
};

/// Both must have points at multiples of `spacing` [data units] (TraceOptions::step).
[[nodiscard]] LineComparison compare_lines(std::span<const Line> lines, std::span<const Line> reference,
                                           double spacing, double diagonal);

/// Ends in a sink or on itself, or winds up: the second half of its length stays within kWoundUp of the
/// diagonal. The length of such a line says when a program gave up, and equal arc length compares phases of
/// one small orbit.
[[nodiscard]] bool ends_inside(const Line& line, double diagonal);

/// (1) for one pair of lines, in data units; NaN where they have no arc length in common.
/// @param with_ends also compares the last points.
[[nodiscard]] double line_distance(const Line& line, const Line& reference, double spacing, bool with_ends);

}  // namespace palpate
