/// Edits of tracts that lie packed one after another. Each gives new lines; numbers of points and of lines go with them,
/// interpolated at new points, NaN where a line that came in lacks one. Lengths in mm.
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "common/geometry/tractogram.h"
#include "common/math/vec.h"
#include "common/trace/tract/tract_region.h"

namespace palpate {

/// A place on a line: `part` of the way from its point `point` to the next one.
struct LinePlace {
  std::size_t line = 0;
  std::size_t point = 0;  ///< of the line, from 0; not its last
  double part = 0.0;      ///< in [0, 1]
  Vec3 place{0.0};
  double distance = 0.0;  ///< of what was asked about
};
/// The place of all lines nearest to `x`; none: no line has two points.
[[nodiscard]] std::optional<LinePlace> nearest_place(const Tractogram& lines, const Vec3& x);
/// Likewise of one line. @pre line < lines.line_count().
[[nodiscard]] std::optional<LinePlace> nearest_place_of(const Tractogram& lines, std::size_t line,
                                                        const Vec3& x);

/// What a ray comes nearest to, seen from its origin: the place whose distance from the ray is the smallest part of what
/// is allowed there, radius + spread * (way along the ray). None: no line is so near.
/// @param direction unit. @param radius, spread not both 0.
[[nodiscard]] std::optional<LinePlace> place_along_ray(const Tractogram& lines, const Vec3& origin,
                                                       const Vec3& direction, double radius, double spread);

/// `more` behind `lines`, with all numbers of both. The image stays, or is that of `more` where there was none.
void append_lines(const Tractogram& more, Tractogram& lines);
/// Those numbers, in their order. @pre each < lines.line_count().
[[nodiscard]] Tractogram take_lines(const Tractogram& lines, std::span<const std::size_t> numbers);
/// All but those; numbers that no line has are ignored.
[[nodiscard]] Tractogram delete_lines(const Tractogram& lines, std::span<const std::size_t> numbers);
/// In two at `at`; both begin or end there. The second one is the last line of all.
[[nodiscard]] Tractogram cut_line(const Tractogram& lines, const LinePlace& at);
/// All lines, wherever they cross the plane normal . x = offset; the parts of a line follow each other.
[[nodiscard]] Tractogram part_lines(const Tractogram& lines, const HalfSpace& plane);
/// Line `b` goes on from `a`, both turned so that the nearest two of their ends meet, with a straight piece between; it
/// takes the place of `a`. @pre a != b, both < lines.line_count().
[[nodiscard]] Tractogram join_lines(const Tractogram& lines, std::size_t a, std::size_t b);
/// Each point becomes the mean of its line about it, weighted by a Gaussian of that standard deviation along the line.
/// Towards an end the deviation falls to a third of the way left, so that ends stay where they are.
/// @param deviation > 0.
[[nodiscard]] Tractogram smooth_lines(const Tractogram& lines, double deviation);
/// Points at equal distances along each line, the next larger part of its length to `spacing`; ends stay.
/// @param spacing > 0.
[[nodiscard]] Tractogram resample_lines(const Tractogram& lines, double spacing);
/// Those whose length is in [least, most].
[[nodiscard]] Tractogram lines_of_length(const Tractogram& lines, double least, double most);
/// Those that pass the region, or those that do not. Places no farther apart than kRegionStep are looked at.
[[nodiscard]] Tractogram lines_through(const Tractogram& lines, const TractRegion& region, bool through);
/// The parts that lie in the region, as lines of their own; places as above.
[[nodiscard]] Tractogram cropped_lines(const Tractogram& lines, const TractRegion& region);
inline constexpr double kRegionStep = 0.25;  ///< [mm]

}  // namespace palpate
