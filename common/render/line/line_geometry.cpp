#include "common/render/line/line_geometry.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "common/base/error.h"

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
      const auto number = static_cast<std::uint32_t>(first + i);
      geometry.segments.push_back({number, number + 1});
    }
    if (length > 0.0) chord_before = chord;
    here = next;
  }
}

}  // namespace

std::vector<double> line_values(const std::vector<Line>& lines, const LineStyle& style) {
  std::size_t count = 0;
  for (const Line& line : lines) count += line.points.size();
  std::vector<double> values;
  values.reserve(count);
  if (style.color_by == ColorBy::kArray) {
    if (!style.array || style.array->values.size() != count) {
      throw work_error("the array that colours the lines has " +
                       std::to_string(style.array ? style.array->values.size() : 0) + " values for " +
                       std::to_string(count) + " points");
    }
    values.assign(style.array->values.begin(), style.array->values.end());
    return values;
  }
  for (const Line& line : lines) {
    for (const LinePoint& point : line.points) {
      double value = 0.0;
      switch (style.color_by) {
        case ColorBy::kSpeed:
          value = point.speed;
          break;
        case ColorBy::kTime:
          value = point.time;
          break;
        case ColorBy::kArc:
          value = point.arc;
          break;
        case ColorBy::kError:
          value = point.error;
          break;
        case ColorBy::kTermination:
          value = static_cast<double>(line.end);
          break;
        case ColorBy::kSeed:
          value = line.seed;
          break;
        default:
          break;
      }
      values.push_back(value);
    }
  }
  return values;
}

std::vector<float> map_coordinates(const std::vector<double>& values, const LineStyle& style,
                                   const ValueRange& range) {
  std::vector<float> coordinates(values.size());
  if (style.color_by == ColorBy::kTermination) {
    std::transform(values.begin(), values.end(), coordinates.begin(),
                   [](double v) { return static_cast<float>((v + 0.5) / kCategoryCount); });
    return coordinates;
  }
  const bool logarithmic = is_logarithmic(style);
  const auto place = [&](double v) {
    // Ratios, not differences of logarithms or of huge numbers: exact under power-of-two scaling.
    if (logarithmic)
      return v > 0.0 ? std::log10(v / range.lower) / std::log10(range.upper / range.lower) : 0.0;
    return (v - range.lower) / (range.upper - range.lower);
  };
  const bool flat = !(range.upper > range.lower) || (logarithmic && !(range.lower > 0.0));
  std::transform(values.begin(), values.end(), coordinates.begin(), [&](double v) {
    if (std::isnan(v)) return std::numeric_limits<float>::quiet_NaN();
    return flat ? 0.5F : static_cast<float>(std::clamp(place(v), 0.0, 1.0));
  });
  return coordinates;
}

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

LineGeometry make_line_geometry(std::span<const std::span<const Vec3f>> polylines, const SceneFrame& frame) {
  LineGeometry geometry;
  for (const auto& polyline : polylines) {
    append(geometry, polyline.size(), frame, [&](std::size_t i) { return Vec3(polyline[i]); });
  }
  return geometry;
}

std::vector<LineSegment> join_segments(std::span<const LineVertex> vertices,
                                       std::span<const LineSegment> segments,
                                       std::span<const float> coordinates, const LineTolerance& tolerance) {
  // Segments that one new segment may span: bounds the work, which grows with the square of it.
  constexpr std::size_t kMostJoined = 24;
  const auto largest = static_cast<float>(tolerance.distance * tolerance.distance);

  // Whether the ends of `part`, a run of segments, lie on the straight piece between the first and the last of them.
  const auto straight = [&](std::span<const LineSegment> part) {
    const std::uint32_t first = part.front().first, last = part.back().last;
    const Vec3f start = vertices[first].position;
    const Vec3f chord = vertices[last].position - start;
    const float square = glm::dot(chord, chord);
    if (!(square > 0.0F)) return false;
    const Vec3f along = chord / std::sqrt(square);
    const auto fits = [&](std::uint32_t i) {
      const LineVertex& vertex = vertices[i];
      if (!(glm::dot(vertex.tangent, along) >= tolerance.cosine)) return false;
      const Vec3f offset = vertex.position - start;
      const float place = glm::dot(offset, chord) / square;
      const Vec3f beside = offset - place * chord;
      if (!(glm::dot(beside, beside) <= largest)) return false;
      if (coordinates.empty()) return true;
      const float between = coordinates[first] + place * (coordinates[last] - coordinates[first]);
      return std::abs(coordinates[i] - between) <= tolerance.coordinate;  // false for NaN
    };
    return fits(first) &&
           std::all_of(part.begin(), part.end(), [&](const LineSegment& s) { return fits(s.last); });
  };

  std::vector<LineSegment> joined;
  joined.reserve(segments.size());
  std::size_t begin = 0;  // of the segments that the last new one spans
  for (std::size_t i = 0; i < segments.size(); ++i) {
    if (!joined.empty() && joined.back().last == segments[i].first && i - begin < kMostJoined &&
        straight(segments.subspan(begin, i - begin + 1))) {
      joined.back().last = segments[i].last;
    } else {
      begin = i;
      joined.push_back(segments[i]);
    }
  }
  joined.shrink_to_fit();
  return joined;
}

std::vector<LineSegment> simplify(const LineGeometry& geometry, std::span<const float> coordinates,
                                  double tolerance) {
  // Runs over runs: together they move a line by no more than the tolerance.
  std::vector<LineSegment> joined =
      join_segments(geometry.vertices, geometry.segments, coordinates, {.distance = 0.75 * tolerance});
  return join_segments(geometry.vertices, joined, coordinates, {.distance = 0.25 * tolerance});
}

std::vector<LineSegment> sample_lines(std::span<const LineSegment> segments, double share) {
  // Multiples of the golden ratio lie evenly in [0, 1), whatever of them is taken.
  constexpr double kGolden = 0.6180339887498949;
  std::vector<LineSegment> taken;
  double line = -1.0;
  bool takes = false;
  for (std::size_t i = 0; i < segments.size(); ++i) {
    if (i == 0 || segments[i].first != segments[i - 1].last) {
      line += 1.0;
      takes = line * kGolden - std::floor(line * kGolden) < share;
    }
    if (takes) taken.push_back(segments[i]);
  }
  return taken;
}

void sort_back_to_front(std::vector<LineSegment>& segments, std::span<const LineVertex> vertices,
                        const Vec3f& back) {
  std::vector<std::pair<float, LineSegment>> keys;
  keys.reserve(segments.size());
  for (const LineSegment& s : segments) {
    keys.emplace_back(glm::dot(vertices[s.first].position + vertices[s.last].position, back), s);
  }
  std::sort(keys.begin(), keys.end(), [](const auto& a, const auto& b) {
    return a.first < b.first || (a.first == b.first && a.second.first < b.second.first);
  });
  std::transform(keys.begin(), keys.end(), segments.begin(), [](const auto& key) { return key.second; });
}

}  // namespace palpate
