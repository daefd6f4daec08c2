#include "common/render/line/line_geometry.h"

#include <algorithm>
#include <utility>

namespace palpate {
namespace {

// `position(i)` is point i of a polyline of `count` points, in data coordinates.
template <class Position>
void append(LineGeometry& geometry, std::size_t count, const SceneFrame& frame, const Position& position) {
  if (count == 0) return;
  const auto first = geometry.vertices.size();
  Vec3 here = frame.scene_from_data(position(0));
  Vec3 chord_before{0.0};  // unit chord to the point at hand; zero at the start or after a double point
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3 next = i + 1 < count ? frame.scene_from_data(position(i + 1)) : here;
    const Vec3 step = next - here;
    const double length = glm::length(step);
    const Vec3 chord = length > 0.0 ? step / length : Vec3{0.0};

    // The bisector of the chords; where the line turns back on itself it vanishes, and a chord is used.
    Vec3 tangent = chord_before + chord;
    const double size = glm::length(tangent);
    constexpr double kTurnsBack = 1e-6;
    if (size > kTurnsBack) {
      tangent /= size;
    } else {
      tangent = chord_before;
    }
    geometry.vertices.push_back({.position = Vec3f(here), .tangent = Vec3f(tangent)});
    if (i + 1 < count && length > 0.0 && is_finite(here) && is_finite(next)) {
      geometry.segments.push_back(static_cast<std::uint32_t>(first + i));
    }
    if (length > 0.0) chord_before = chord;
    here = next;
  }
}

}  // namespace

LineGeometry make_line_geometry(const std::vector<Line>& lines, const SceneFrame& frame) {
  LineGeometry geometry;
  std::size_t count = 0;
  for (const Line& line : lines) count += line.points.size();
  geometry.vertices.reserve(count);
  geometry.segments.reserve(count);
  for (const Line& line : lines) {
    append(geometry, line.points.size(), frame,
           [&](std::size_t i) -> const Vec3& { return line.points[i].position; });
  }
  return geometry;
}

LineGeometry make_line_geometry(const std::vector<std::vector<Vec3>>& polylines, const SceneFrame& frame) {
  LineGeometry geometry;
  for (const auto& polyline : polylines) {
    append(geometry, polyline.size(), frame, [&](std::size_t i) -> const Vec3& { return polyline[i]; });
  }
  return geometry;
}

void sort_back_to_front(std::vector<std::uint32_t>& segments, std::span<const LineVertex> vertices,
                        const Vec3f& back) {
  std::vector<std::pair<float, std::uint32_t>> keys(segments.size());
  std::transform(segments.begin(), segments.end(), keys.begin(), [&](std::uint32_t s) {
    return std::pair{glm::dot(vertices[s].position + vertices[s + 1].position, back), s};
  });
  std::sort(keys.begin(), keys.end());
  std::transform(keys.begin(), keys.end(), segments.begin(), [](const auto& key) { return key.second; });
}

}  // namespace palpate
