#include "common/render/tract/tract_points.h"

#include <cmath>
#include <span>

#include "common/render/line/line_geometry.h"

namespace palpate {

std::uint32_t packed_tangent(const Vec3f& tangent) noexcept {
  constexpr float kMost = 511.0F;
  constexpr std::uint32_t kTenBits = 1023;
  const auto bits = [&](float x) { return static_cast<std::uint32_t>(std::lround(kMost * x)) & kTenBits; };
  return bits(tangent.x) | bits(tangent.y) << 10U | bits(tangent.z) << 20U;
}

std::vector<TractPoint> piece_points(const TractBundle& bundle, std::size_t piece, const SceneFrame& frame,
                                     double tolerance) {
  const auto [first, last] = bundle.pieces[piece];
  std::vector<std::span<const Vec3f>> lines;
  lines.reserve(last - first);
  for (std::size_t i = first; i < last; ++i) lines.push_back(bundle.lines->line(bundle.order[i]));
  const LineGeometry whole = make_line_geometry(lines, frame);
  const std::vector<LineSegment> segments = simplify(whole, {}, tolerance);

  std::vector<TractPoint> points;
  points.reserve(segments.size() + 2 * lines.size());
  const auto add = [&](std::uint32_t number) {
    const LineVertex& vertex = whole.vertices[number];
    points.push_back({vertex.position, packed_tangent(vertex.tangent)});
  };
  std::uint32_t end = 0;
  for (const LineSegment& segment : segments) {
    if (points.empty() || segment.first != end) {
      if (!points.empty()) points.push_back({.tangent = TractPoint::kBetweenLines});
      add(segment.first);
    }
    add(segment.last);
    end = segment.last;
  }
  return points;
}

}  // namespace palpate
