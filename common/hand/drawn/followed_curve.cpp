#include "common/hand/drawn/followed_curve.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "common/trace/line_time.h"

namespace palpate {
namespace {

constexpr double kChordGap = 5e-7;  // diagonals
constexpr int kMostParts = 64;      // that a piece is drawn with
constexpr int kMostBalls = 300;

/// Chords that a piece needs: a chord of length h leaves a curve of curvature c by c h^2 / 8.
int parts_of(const HermitePiece& piece, double gap) {
  const double bend = std::max(glm::length(piece.bend(0.0)), glm::length(piece.bend(piece.length)));
  const double parts = piece.length * std::sqrt(bend / (8.0 * gap));
  return std::isfinite(parts) ? std::clamp(static_cast<int>(std::ceil(parts)), 1, kMostParts) : 1;
}

/// The point `x` between two nodes, at the part u.
LinePoint between(const LineNode& a, const LineNode& b, double u, const Vec3& x, const LocalFrame& frame) {
  const auto mix = [u](double from, double to) { return from + u * (to - from); };
  return {.position = frame.data_from_local(x),
          .time = mix(a.time, b.time) * frame.time_scale(),
          .arc = mix(a.arc, b.arc) * frame.length_scale(),
          .speed = mix(a.speed, b.speed) * frame.speed_scale(),
          .error = mix(a.error, b.error) * frame.length_scale()};
}

std::vector<LinePoint> balls_of(const GrowingLine& line, const LocalFrame& frame, double interval) {
  std::vector<LinePoint> balls;
  const int first = line.first(), last = line.last();
  const double begin = line.node(first).time, end = line.node(last).time;
  if (!(interval > 0.0) || !std::isfinite(begin) || !std::isfinite(end) || first == last) return balls;
  // About the seed, so that balls stay where they are while the line grows.
  const double spread = 0.5 * kMostBalls * interval;
  const double from = std::max(begin, line.node(0).time - spread);
  const double until = std::min(end, line.node(0).time + spread);
  int piece = first;
  for (double k = std::ceil(from / interval); k * interval <= until; k += 1.0) {
    const TimePlace place = find_time(line, piece, k * interval, last - first);
    if (!place.found) break;
    piece = place.piece;
    const LineNode &a = line.node(piece), &b = line.node(piece + 1);
    const double s = place.arc - a.arc;
    balls.push_back(between(a, b, s / (b.arc - a.arc), line.piece(piece).at(s), frame));
  }
  return balls;
}

/// What colours each of the points; none where they do not carry it.
std::vector<double> values_of(const std::vector<LinePoint>& points, const std::optional<End>& end,
                              const LineStyle& style) {
  std::vector<double> values;
  const auto each = [&](const auto& value) {
    for (const LinePoint& point : points) values.push_back(value(point));
  };
  CellHint hint;
  switch (style.color_by) {
    case ColorBy::kSpeed:
      each([](const LinePoint& point) { return point.speed; });
      break;
    case ColorBy::kTime:
      each([](const LinePoint& point) { return point.time; });
      break;
    case ColorBy::kArc:
      each([](const LinePoint& point) { return point.arc; });
      break;
    case ColorBy::kError:
      each([](const LinePoint& point) { return point.error; });
      break;
    case ColorBy::kTermination:
      if (end) values.assign(points.size(), static_cast<double>(*end));
      break;
    case ColorBy::kArray:
      if (style.array && style.array->at)
        each([&](const LinePoint& point) { return style.array->at(point.position, hint); });
      break;
    case ColorBy::kDirection:
    case ColorBy::kSeed:
    case ColorBy::kUniform:
      break;
  }
  return values;
}

std::vector<Vec3> places_of(const std::vector<LinePoint>& points) {
  std::vector<Vec3> places;
  places.reserve(points.size());
  for (const LinePoint& point : points) places.push_back(point.position);
  return places;
}

Line whole_line(const GrowingLine& line, const LocalFrame& frame) {
  Line result;
  const int first = line.first(), last = line.last();
  const double start = line.node(first).arc;
  for (int i = first; i <= last; ++i) {
    const LineNode& node = line.node(i);
    result.points.push_back({.position = frame.data_from_local(node.position),
                             .time = node.time * frame.time_scale(),
                             .arc = (node.arc - start) * frame.length_scale(),
                             .speed = node.speed * frame.speed_scale(),
                             .error = (node.error + node.gap) * frame.length_scale()});
  }
  result.end = line.end(GrowingLine::Side::kDownstream).value_or(End::kMaxLength);
  return result;
}

}  // namespace

FollowedCurve::FollowedCurve(std::shared_ptr<const LiveLine> live, const FollowedCurve* before)
    : live_(std::move(live)) {
  if (before == nullptr) return;
  shape_ = before->shape_;
  last_ = before->last_;
  color_by_ = before->color_by_;
  array_ = before->array_;
}

/// Notes how far it has grown.
bool FollowedCurve::has_grown(const GrowingLine& line, std::uint64_t number, double ball_interval) {
  const int first = line.first(), last = line.last();
  const std::optional<End> end = line.end(GrowingLine::Side::kDownstream);
  if (number == number_ && first == first_node_ && last == last_node_ && ball_interval == ball_interval_ &&
      end == shape_.end)
    return false;
  number_ = number;
  first_node_ = first;
  last_node_ = last;
  ball_interval_ = ball_interval;
  return true;
}

void FollowedCurve::take_shape(const GrowingLine& line, double ball_interval) {
  const VectorField& field = live_->field();
  const LocalFrame& frame = field.frame();
  const double gap = kChordGap * field.diagonal() / frame.length_scale();
  shape_ = {};
  for (int i = line.first(); i < line.last(); ++i) {
    const HermitePiece piece = line.piece(i);
    const int parts = parts_of(piece, gap);
    for (int k = 0; k < parts; ++k) {
      const double u = static_cast<double>(k) / parts;
      shape_.points.push_back(between(line.node(i), line.node(i + 1), u, piece.at(u * piece.length), frame));
    }
  }
  const LineNode& end = line.node(line.last());
  shape_.points.push_back(between(end, end, 0.0, end.position, frame));
  shape_.balls = balls_of(line, frame, ball_interval / frame.time_scale());
  shape_.end = line.end(GrowingLine::Side::kDownstream);
  line_ = whole_line(line, frame);
}

std::shared_ptr<const FollowedLine> FollowedCurve::colored(const LineStyle& style) const {
  auto line = std::make_shared<FollowedLine>();
  line->points = places_of(shape_.points);
  line->values = values_of(shape_.points, shape_.end, style);
  line->balls = places_of(shape_.balls);
  line->ball_values = values_of(shape_.balls, shape_.end, style);
  return line;
}

void FollowedCurve::update(double ball_interval, const LineStyle& style) {
  bool other = style.color_by != color_by_ || style.array != array_;
  color_by_ = style.color_by;
  array_ = style.array;
  live_->read([&](const GrowingLine* line, std::uint64_t number) {
    if (line == nullptr) {
      number_ = 0;
    } else if (has_grown(*line, number, ball_interval)) {
      take_shape(*line, ball_interval);
      other = true;
    }
  });
  if (other && !shape_.points.empty()) last_ = colored(style);
  drawn_ = number_ == 0 ? nullptr : last_;
}

}  // namespace palpate
