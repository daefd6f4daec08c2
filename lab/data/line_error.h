/// How far lines lie from reference lines.
///
/// Two lines of one seed and direction are compared at equal arc lengths s = k S and at their ends:
///
///   e = max_k |x(k S) - y(k S)|,  and |x(end) - y(end)| where both end for the same reason       (1)
///
/// Equal arc length is stricter than the distance between curves: being late on the right curve counts. Where
/// the reference runs into a sink or closes on itself, and the line does too, neither counts: equal arc length
/// would compare where two programs gave up. Every other line of the reference is judged: compared, or, where
/// there is no such line, or it ends elsewhere for another reason, more than S of arc away, failed. The error of
/// a failed line is infinite.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "common/geometry/line.h"

namespace palpate {

/// How one line of the reference is met.
enum class Meeting : std::uint8_t {
  kCompared,
  kInside,      ///< both end inside
  kElsewhere,   ///< the line ends for another reason, elsewhere
  kUnfinished,  ///< it ends by its number of steps
  kMissing      ///< there is none
};
[[nodiscard]] const char* name_of(Meeting meeting) noexcept;

struct LineJudgement {
  std::uint32_t seed = 0;
  TraceDirection direction = TraceDirection::kForward;
  Meeting meeting = Meeting::kMissing;
  End end = End::kLeftDomain, reference_end = End::kLeftDomain;
  double error = 0.0;   ///< (1) over the diagonal; infinite where it failed
  double stated = 0.0;  ///< what the line states at its end, over the diagonal; NaN where it states nothing
};

struct LineComparison {
  std::vector<LineJudgement> lines;  ///< of the reference, in its order: all that follows is made from them
  double median = 0.0;  ///< of the errors of the judged lines, infinite ones too; NaN where none was judged
  double p95 = 0.0;     ///< 95 % of the judged lines lie below
  double max = 0.0;     ///< of the compared lines
  std::size_t judged = 0;  ///< compared or failed
  std::size_t compared = 0;
  std::size_t inside = 0;
  std::size_t elsewhere = 0, unfinished = 0, missing = 0;  ///< failed
  double stated = 0.0;  ///< the 95 % quantile of what the compared lines state as their own error
  /// The part of the judged lines whose error is at most what they state; NaN where the compared ones state nothing.
  double covered = 0.0;

  [[nodiscard]] std::size_t failed() const noexcept { return elsewhere + unfinished + missing; }
};

/// Both must have points at multiples of `spacing` [data units] (TraceOptions::step).
/// @param to_the_end false: the lines of a program that stops somewhere before the border are not compared at their ends, and one that
/// stops more than `spacing` of arc away has failed.
[[nodiscard]] LineComparison compare_lines(std::span<const Line> lines, std::span<const Line> reference,
                                           double spacing, double diagonal, bool to_the_end = true);

/// Ends in a sink or on itself, or winds up: the second half of its length stays within kWoundUp of the
/// diagonal. The length of such a line says when a program gave up, and equal arc length compares phases of
/// one small orbit.
[[nodiscard]] bool ends_inside(const Line& line, double diagonal);

/// (1) for one pair of lines, in data units; NaN where they have no arc length in common.
/// @param with_ends also compares the last points.
[[nodiscard]] double line_distance(const Line& line, const Line& reference, double spacing, bool with_ends);

}  // namespace palpate
