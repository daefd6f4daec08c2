/// Lines as the GPU draws them: points in the scene frame with tangents, and the segments between them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "common/geometry/line.h"
#include "common/render/camera.h"

namespace palpate {

/// One point, as laid out in the shader's buffer.
struct LineVertex {
  Vec3f position{0.0F};  ///< scene frame
  float padding0 = 0.0F;
  Vec3f tangent{0.0F};  ///< unit, or zero for a line without extent
  float padding1 = 0.0F;
};

struct LineGeometry {
  std::vector<LineVertex> vertices;
  std::vector<std::uint32_t> segments;  ///< index of the first point of each segment; the next is its end
};

/// Vertices of all points in order, line after line. Segments whose ends coincide, or are not finite,
/// are left out.
[[nodiscard]] LineGeometry make_line_geometry(const std::vector<Line>& lines, const SceneFrame& frame);
[[nodiscard]] LineGeometry make_line_geometry(const std::vector<std::vector<Vec3>>& polylines,
                                              const SceneFrame& frame);

/// Orders segments from far to near along `back` (toward the viewer), by their middle; equal ones keep
/// their order.
void sort_back_to_front(std::vector<std::uint32_t>& segments, std::span<const LineVertex> vertices,
                        const Vec3f& back);

}  // namespace palpate
