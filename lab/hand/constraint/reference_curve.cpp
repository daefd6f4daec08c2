#include "lab/hand/constraint/reference_curve.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "common/base/index.h"
#include "common/trace/trace.h"

namespace palpate {
namespace {

constexpr double kTolerance = 1e-10;  // a thousandth of what hands follow
constexpr double kSpacing = 2e-4;     // diagonals
constexpr double kSamePoint = 1e-9;   // diagonals: nearer points make parabolas of rounding
constexpr int kMaxSteps = 20'000;

}  // namespace

ReferenceCurve::ReferenceCurve(const VectorField& field, const Vec3& seed, double length) {
  const auto sort = [this] {
    std::sort(points_.begin(), points_.end(), [](const Point& a, const Point& b) { return a.arc < b.arc; });
  };
  add(field, seed, length, kSpacing * field.diagonal());
  sort();
  if (turns_sharply()) {
    add(field, seed, length, 0.0);  // the tracer's own points are dense where the curve turns
    sort();
  }
  const double same = kSamePoint * field.diagonal();
  points_.erase(std::unique(points_.begin(), points_.end(),
                            [same](const Point& a, const Point& b) { return b.arc - a.arc < same; }),
                points_.end());
  const auto after = std::lower_bound(points_.begin(), points_.end(), 0.0,
                                      [](const Point& p, double arc) { return p.arc < arc; });
  seed_ = std::min(as_size(after - points_.begin()), std::max<std::size_t>(points_.size(), 1) - 1);
}

/// Adds the points of one tracing.
void ReferenceCurve::add(const VectorField& field, const Vec3& seed, double length, double spacing) {
  const std::array<Vec3, 1> seeds{seed};
  // An implicit method: neither that of tetrahedra nor that of the other grids, and at home in stiff flow.
  const TraceResult traced = trace_lines(field, seeds,
                                         {.integrator = Integrator::kRodas4,
                                          .backward = true,
                                          .tolerance = kTolerance,
                                          .step = spacing,
                                          .max_length = length,
                                          .max_steps = kMaxSteps,
                                          .threads = 1});
  for (const Line& line : traced.lines) {
    const bool forward = line.direction == TraceDirection::kForward;
    const bool cut = line.end != End::kLeftDomain && line.end != End::kBadData;
    (forward ? open_end_ : open_begin_) |= cut;
    for (const LinePoint& p : line.points) points_.push_back({forward ? p.arc : -p.arc, p.position});
  }
}

/// Whether a parabola through neighbouring points would miss a corner.
bool ReferenceCurve::turns_sharply() const noexcept {
  constexpr double kCosine = 0.9998;  // of 1.1 degrees
  for (std::size_t i = 2; i < points_.size(); ++i) {
    const Vec3 before = points_[i - 1].position - points_[i - 2].position;
    const Vec3 after = points_[i].position - points_[i - 1].position;
    if (glm::dot(before, after) < kCosine * glm::length(before) * glm::length(after)) return true;
  }
  return false;
}

/// The parabola through three neighbouring points, by arc length. @pre 0 < middle < points - 1.
Vec3 ReferenceCurve::at(std::size_t middle, double arc) const noexcept {
  const Point &a = points_[middle - 1], &b = points_[middle], &c = points_[middle + 1];
  const double to_a = arc - a.arc, to_b = arc - b.arc, to_c = arc - c.arc;
  const double ab = b.arc - a.arc, bc = c.arc - b.arc, ac = c.arc - a.arc;
  return (to_b * to_c / (ab * ac)) * a.position - (to_a * to_c / (ab * bc)) * b.position +
         (to_a * to_b / (ac * bc)) * c.position;
}

double ReferenceCurve::squared_distance(std::size_t i, const Vec3& x) const noexcept {
  const Vec3 away = points_[i].position - x;
  return glm::dot(away, away);
}

ReferenceCurve::Place ReferenceCurve::nearest(const Vec3& x, std::size_t from) const noexcept {
  std::size_t i = from;
  while (i + 1 < points_.size() && squared_distance(i + 1, x) < squared_distance(i, x)) ++i;
  if (i == from) {
    while (i > 0 && squared_distance(i - 1, x) < squared_distance(i, x)) --i;
  }
  return refined(x, i);
}

ReferenceCurve::Place ReferenceCurve::nearest_of_all(const Vec3& x) const noexcept {
  std::size_t nearest = 0;
  for (std::size_t i = 1; i < points_.size(); ++i) {
    if (squared_distance(i, x) < squared_distance(nearest, x)) nearest = i;
  }
  return refined(x, nearest);
}

/// The nearest place of the parabola about the point `i`.
ReferenceCurve::Place ReferenceCurve::refined(const Vec3& x, std::size_t i) const noexcept {
  // Golden section between the neighbours: slow and sure.
  const std::size_t middle = std::clamp<std::size_t>(i, 1, points_.size() - 2);
  double low = points_[i > 0 ? i - 1 : 0].arc, high = points_[std::min(i + 1, points_.size() - 1)].arc;
  constexpr double kGolden = 0.6180339887498949;
  constexpr int kSections = 60;
  const auto distance = [&](double arc) { return glm::distance(at(middle, arc), x); };
  double left = high - kGolden * (high - low), right = low + kGolden * (high - low);
  double at_left = distance(left), at_right = distance(right);
  for (int n = 0; n < kSections; ++n) {
    if (at_left < at_right) {
      high = right;
      right = left;
      at_right = at_left;
      left = high - kGolden * (high - low);
      at_left = distance(left);
    } else {
      low = left;
      left = right;
      at_left = at_right;
      right = low + kGolden * (high - low);
      at_right = distance(right);
    }
  }
  const double arc = 0.5 * (low + high);
  const bool beyond = (i == 0 && open_begin_) || (i + 1 == points_.size() && open_end_);
  return {i, arc, at(middle, arc), beyond};
}

}  // namespace palpate
