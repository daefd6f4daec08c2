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

/// What colours the line between two nodes, at the part u; NaN for what it does not carry.
double value_between(const LineNode& a, const LineNode& b, double u, ColorBy by, const LocalFrame& frame) {
  const auto mix = [u](double x, double y) { return x + u * (y - x); };
  switch (by) {
    case ColorBy::kSpeed:
      return mix(a.speed, b.speed) * frame.speed_scale();
    case ColorBy::kTime:
      return mix(a.time, b.time) * frame.time_scale();
    case ColorBy::kArc:
      return mix(a.arc, b.arc) * frame.length_scale();
    case ColorBy::kError:
      return mix(a.error, b.error) * frame.length_scale();
    default:
      return std::numeric_limits<double>::quiet_NaN();
  }
}

bool carries(ColorBy by) {
  return by == ColorBy::kSpeed || by == ColorBy::kTime || by == ColorBy::kArc || by == ColorBy::kError;
}

void add_balls(const GrowingLine& line, const LocalFrame& frame, double interval, ColorBy by,
               FollowedLine& drawn) {
  const int first = line.first(), last = line.last();
  const double begin = line.node(first).time, end = line.node(last).time;
  if (!(interval > 0.0) || !std::isfinite(begin) || !std::isfinite(end) || first == last) return;
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
    drawn.balls.push_back(frame.data_from_local(line.piece(piece).at(s)));
    if (carries(by)) drawn.ball_values.push_back(value_between(a, b, s / (b.arc - a.arc), by, frame));
  }
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

FollowedCurve::FollowedCurve(std::shared_ptr<const LiveLine> live) : live_(std::move(live)) {}

void FollowedCurve::update(double ball_interval, ColorBy color_by) {
  const VectorField& field = live_->field();
  const LocalFrame& frame = field.frame();
  live_->read([&](const GrowingLine* line, std::uint64_t number) {
    if (line == nullptr) {
      drawn_.reset();
      number_ = 0;
      return;
    }
    const int first = line->first(), last = line->last();
    if (number == number_ && first == first_ && last == last_ && ball_interval == ball_interval_ &&
        color_by == color_by_) {
      return;
    }
    number_ = number;
    first_ = first;
    last_ = last;
    ball_interval_ = ball_interval;
    color_by_ = color_by;
    auto drawn = std::make_shared<FollowedLine>();
    const double gap = kChordGap * field.diagonal() / frame.length_scale();
    const auto add = [&](const Vec3& x, const LineNode& a, const LineNode& b, double u) {
      drawn->points.push_back(frame.data_from_local(x));
      if (carries(color_by)) drawn->values.push_back(value_between(a, b, u, color_by, frame));
    };
    for (int i = first; i < last; ++i) {
      const HermitePiece piece = line->piece(i);
      const int parts = parts_of(piece, gap);
      for (int k = 0; k < parts; ++k) {
        const double u = static_cast<double>(k) / parts;
        add(piece.at(u * piece.length), line->node(i), line->node(i + 1), u);
      }
    }
    add(line->node(last).position, line->node(last), line->node(last), 0.0);
    add_balls(*line, frame, ball_interval / frame.time_scale(), color_by, *drawn);
    drawn_ = std::move(drawn);
    line_ = whole_line(*line, frame);
  });
}

}  // namespace palpate
