/// Lines as the GPU draws them: points in the scene frame with tangents, and the segments between them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "common/geometry/line.h"
#include "common/render/camera.h"
#include "common/render/line_style.h"

namespace palpate {

/// One point, as laid out in the shader's buffer.
struct LineVertex {
  Vec3f position{0.0F};  ///< scene frame
  float padding0 = 0.0F;
  Vec3f tangent{0.0F};  ///< unit, or zero for a line without extent
  float padding1 = 0.0F;
};

/// A straight piece between two vertices of one line, first < last.
struct LineSegment {
  std::uint32_t first = 0;
  std::uint32_t last = 0;

  bool operator==(const LineSegment&) const = default;
};

struct LineGeometry {
  std::vector<LineVertex> vertices;
  std::vector<LineSegment> segments;  ///< in the order of the lines
};

/// Vertices of all points in order, line after line. Segments whose ends coincide, or are not finite,
/// are left out.
[[nodiscard]] LineGeometry make_line_geometry(const std::vector<Line>& lines, const SceneFrame& frame);
[[nodiscard]] LineGeometry make_line_geometry(const std::vector<std::vector<Vec3>>& polylines,
                                              const SceneFrame& frame);
[[nodiscard]] LineGeometry make_line_geometry(std::span<const std::span<const Vec3f>> polylines,
                                              const SceneFrame& frame);

/// What may change unseen where points of a line are left out.
struct LineTolerance {
  double distance = 0.0;  ///< of a point that is left out from the new segment (scene frame)
  float cosine = 0.99F;   ///< least of the angle between a tangent there and the segment: 8 degrees
  float coordinate =
      2.0F / 256.0F;  ///< of the map coordinate there from the one between the ends: two steps of the table
};

/// Joins segments that follow each other where the picture does not change by it: the points between
/// lie within `tolerance` of the new segment, and their tangents and map coordinates are
/// nearly those that are interpolated along it. Exact tracing gives a point a cell: far more than a
/// picture of the whole shows.
/// @param coordinates in the colour map, one a vertex, or empty.
[[nodiscard]] std::vector<LineSegment> simplify(const LineGeometry& geometry,
                                                std::span<const float> coordinates, double tolerance);
/// The same of what is left of the segments already: tangents and coordinates are looked at where `segments` meet.
[[nodiscard]] std::vector<LineSegment> join_segments(std::span<const LineVertex> vertices,
                                                     std::span<const LineSegment> segments,
                                                     std::span<const float> coordinates,
                                                     const LineTolerance& tolerance);

/// Of the lines that `segments` make an even sample with about `share` of them. Lines of a smaller share are among those
/// of a larger one. @param share in (0, 1].
[[nodiscard]] std::vector<LineSegment> sample_lines(std::span<const LineSegment> segments, double share);

/// Orders segments from far to near along `back` (toward the viewer), by their middle; equal ones are
/// ordered by number.
void sort_back_to_front(std::vector<LineSegment>& segments, std::span<const LineVertex> vertices,
                        const Vec3f& back);

/// One number a point of what `style` colours by, line after line, in data units; the seed's index for
/// kSeed, the number of the end reason for kTermination, zeros for kDirection and kUniform.
/// @throws Error (work failed) where the style's array has another number of values than there are points.
[[nodiscard]] std::vector<double> line_values(const std::vector<Line>& lines, const LineStyle& style);

/// Where each value lies in the map: 0 at the range's lower end, 1 at its upper one, clamped; NaN stays
/// NaN. A range without extent gives 1/2.
[[nodiscard]] std::vector<float> map_coordinates(const std::vector<double>& values, const LineStyle& style,
                                                 const ValueRange& range);

}  // namespace palpate
