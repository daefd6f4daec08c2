#include "common/hand/technique/scene_pick.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "common/base/error.h"
#include "common/base/text.h"

namespace palpate {
namespace {

/// The best one so far: by what comes first, then by how far along or off it is.
struct Best {
  std::optional<Picked> picked;
  double measure = HUGE_VAL;

  void take(const Picked& found, double at) {
    if (!(at < measure)) return;
    measure = at;
    picked = found;
  }
};

/// Along the beam and off its axis.
struct AtAxis {
  double along = 0.0, off = 0.0;
};
AtAxis at_axis(const PickBeam& beam, const Vec3& x) {
  const Vec3 from = x - beam.origin;
  const double along = glm::dot(from, beam.direction);
  return {along, glm::length(from - along * beam.direction)};
}

/// The point of a segment that is nearest to the axis of a ray; that along the axis which is before the
/// origin does not count.
Vec3 nearest_to_axis(const PickBeam& beam, const Vec3& a, const Vec3& b) {
  // Across the axis: the nearest point of a segment to the origin of that plane.
  const auto across = [&](const Vec3& x) { return x - glm::dot(x, beam.direction) * beam.direction; };
  const Vec3 from = across(a - beam.origin), along = across(b - a);
  const double square = glm::dot(along, along);
  const double u = square > 0.0 ? std::clamp(-glm::dot(from, along) / square, 0.0, 1.0) : 0.0;
  return a + u * (b - a);
}

/// The point of a segment that is nearest to the axis in angle as seen from the origin; none where all of it
/// is behind that.
std::optional<Vec3> nearest_in_angle(const PickBeam& beam, Vec3 a, Vec3 b) {
  const auto depth = [&](const Vec3& x) { return glm::dot(x - beam.origin, beam.direction); };
  double za = depth(a), zb = depth(b);
  if (za < zb) {
    std::swap(a, b);
    std::swap(za, zb);
  }
  if (!(za > 0.0)) return std::nullopt;
  // Not quite up to the eye's own plane, where all is infinitely far off.
  constexpr double kNearest = 1e-6;
  const double least = kNearest * za;
  if (zb < least) {
    b = a + ((za - least) / (za - zb)) * (b - a);
    zb = least;
  }
  const auto seen = [&](const Vec3& x, double z) { return (x - beam.origin - z * beam.direction) / z; };
  const Vec3 from = seen(a, za), along = seen(b, zb) - from;
  const double square = glm::dot(along, along);
  const double t = square > 0.0 ? std::clamp(-glm::dot(from, along) / square, 0.0, 1.0) : 0.0;
  // Parts of a segment in the picture are not those in space.
  const double u = t * za / (t * za + (1.0 - t) * zb);
  return a + u * (b - a);
}

std::optional<Picked> first_along(const PickScene& scene, const PickBeam& beam) {
  Best best;
  for (std::size_t i = 0; i < scene.handles.size(); ++i) {
    const PickBall& ball = scene.handles[i];
    const auto [along, off] = at_axis(beam, ball.center);
    if (!(off <= ball.radius) || along + ball.radius < 0.0) continue;
    const double enters = std::max(0.0, along - std::sqrt(ball.radius * ball.radius - off * off));
    best.take({PickKind::kHandle, i, beam.origin + enters * beam.direction}, enters);
  }
  for (std::size_t i = 0; i < scene.lenses.size(); ++i) {
    const Lens& lens = scene.lenses[i];
    if (lens.screen || (!lens.shape.quadric && lens.shape.half_spaces.empty())) continue;
    const LineInterval inside = clip_line(lens.shape, beam.origin, beam.direction);
    if (!(inside.first < inside.last) || !(inside.last > 0.0)) continue;
    const double enters = std::max(0.0, inside.first);
    // Where a half-space goes on for ever, it is met at once.
    if (!std::isfinite(enters)) continue;
    best.take({PickKind::kLens, i, beam.origin + enters * beam.direction}, enters);
  }
  for (std::size_t i = 0; i < scene.lines.size(); ++i) {
    const auto& points = scene.lines[i].points;
    for (std::size_t k = 1; k < points.size(); ++k) {
      const Vec3 x = nearest_to_axis(beam, points[k - 1].position, points[k].position);
      const auto [along, off] = at_axis(beam, x);
      if (along > 0.0 && off <= beam.radius) best.take({PickKind::kLine, i, x}, along);
    }
  }
  return best.picked;
}

std::optional<Picked> nearest_in_cone(const PickScene& scene, const PickBeam& beam) {
  Best handle, lens, line;
  const auto angle_of = [&](const Vec3& x) {
    const auto [along, off] = at_axis(beam, x);
    return std::atan2(off, along);
  };
  const double half = std::atan(beam.spread);
  for (std::size_t i = 0; i < scene.handles.size(); ++i) {
    const PickBall& ball = scene.handles[i];
    const double distance = glm::distance(ball.center, beam.origin), angle = angle_of(ball.center);
    const double seen = distance > ball.radius ? std::asin(ball.radius / distance) : HUGE_VAL;
    if (angle <= half + seen) handle.take({PickKind::kHandle, i, ball.center}, angle);
  }
  for (std::size_t i = 0; i < scene.lenses.size(); ++i) {
    const Lens& each = scene.lenses[i];
    if (each.screen || (!each.shape.quadric && each.shape.half_spaces.empty())) continue;
    const Vec3 middle = center_of(each.shape, scene.bounds.center());
    const LineInterval inside = clip_line(each.shape, beam.origin, beam.direction);
    const bool pierced = inside.first < inside.last && inside.last > 0.0;
    const double angle = angle_of(middle);
    if (pierced || angle <= half) lens.take({PickKind::kLens, i, middle}, angle);
  }
  for (std::size_t i = 0; i < scene.lines.size(); ++i) {
    const auto& points = scene.lines[i].points;
    for (std::size_t k = 1; k < points.size(); ++k) {
      const auto x = nearest_in_angle(beam, points[k - 1].position, points[k].position);
      if (!x) continue;
      const double angle = angle_of(*x);
      if (angle <= half) line.take({PickKind::kLine, i, *x}, angle);
    }
  }
  if (handle.picked) return handle.picked;
  return lens.picked ? lens.picked : line.picked;
}

/// Where the axis meets the planes first, within the bounds.
std::optional<Picked> first_plane(const PickScene& scene, const PickBeam& beam) {
  Best best;
  for (std::size_t i = 0; i < scene.planes.size(); ++i) {
    const auto& [n, h] = scene.planes[i];
    const double slope = glm::dot(n, beam.direction), t = (h - glm::dot(n, beam.origin)) / slope;
    if (!(t > 0.0) || !std::isfinite(t)) continue;
    const Vec3 x = beam.origin + t * beam.direction;
    const Box& box = scene.bounds;
    constexpr double kRounding = 1e-9;  // of the size: planes may lie on a face
    const Vec3 slack = kRounding * (box.upper - box.lower);
    if (glm::clamp(x, box.lower - slack, box.upper + slack) == x) best.take({PickKind::kPlane, i, x}, t);
  }
  return best.picked;
}

}  // namespace

std::optional<std::size_t> pick_by_ray(const Ray& ray, std::span<const PickBall> balls) noexcept {
  std::optional<std::size_t> picked;
  double nearest = HUGE_VAL;
  for (std::size_t i = 0; i < balls.size(); ++i) {
    const Vec3 to = balls[i].center - ray.origin;
    const double along = glm::dot(to, ray.direction), aside = glm::length(to - along * ray.direction);
    const double r = balls[i].radius;
    if (!(aside <= r) || along + r < 0.0) continue;
    // Where it goes in, or the origin where that lies within.
    const double enters = std::max(0.0, along - std::sqrt(r * r - aside * aside));
    if (!(enters < nearest)) continue;
    nearest = enters;
    picked = i;
  }
  return picked;
}

std::optional<std::size_t> pick_by_aperture(const Aperture& aperture,
                                            std::span<const PickBall> balls) noexcept {
  const Vec3 axis = aperture.center - aperture.eye;
  const double half = std::atan2(aperture.radius, glm::length(axis));
  std::optional<std::size_t> picked;
  double best = HUGE_VAL, best_distance = HUGE_VAL;
  for (std::size_t i = 0; i < balls.size(); ++i) {
    const Vec3 to = balls[i].center - aperture.eye;
    const double distance = glm::length(to);
    const double off = angle_between(to, axis);
    // A ball around the eye is met by every cone.
    const double seen = distance > balls[i].radius ? std::asin(balls[i].radius / distance) : HUGE_VAL;
    if (!(off <= half + seen)) continue;
    if (off > best || (off == best && !(distance < best_distance))) continue;
    best = off;
    best_distance = distance;
    picked = i;
  }
  return picked;
}

PickBeam beam_of(const Ray& ray, double radius) { return {ray.origin, ray.direction, radius, 0.0}; }

PickBeam beam_of(const Aperture& aperture) {
  const Vec3 axis = aperture.center - aperture.eye;
  const double length = glm::length(axis);
  return {aperture.eye, axis / length, 0.0, aperture.radius / length};
}

PickScene scene_of(const SceneView& view, std::span<const PickBall> handles,
                   std::vector<ConvexShape::HalfSpace>& planes) {
  planes.clear();
  PickScene scene{.handles = handles, .bounds = view.bounds};
  if (view.lines) scene.lines = *view.lines;
  if (view.volume && view.volume->shown) {
    scene.lenses = view.volume->lenses;
    // One that is switched off is not seen, but counted.
    for (const CuttingPlane& cut : view.volume->cuts)
      planes.push_back(cut.on ? cut.kept : ConvexShape::HalfSpace{.outward = Vec3{0.0}});
  }
  scene.planes = planes;
  return scene;
}

std::optional<Picked> pick(const PickScene& scene, const PickBeam& beam) {
  const auto picked = beam.spread > 0.0 ? nearest_in_cone(scene, beam) : first_along(scene, beam);
  return picked ? picked : first_plane(scene, beam);
}

std::string name_of(const Picked& picked) {
  const char* const kind = picked.kind == PickKind::kLens   ? "lens "
                           : picked.kind == PickKind::kLine ? "line "
                                                            : "plane ";
  return kind + std::to_string(picked.index + 1);
}

NoteView note_of(const Picked& picked) {
  return {.points = {picked.place}, .outline = {}, .words = name_of(picked)};
}

PickBeam parse_beam(std::string_view text, double radius, const std::string& option) {
  constexpr std::string_view kRay = "ray:", kAperture = "aperture:";
  std::vector<double> v;
  const bool ray = text.starts_with(kRay);
  if (ray || text.starts_with(kAperture)) {
    for (const std::string_view word : split(text.substr(ray ? kRay.size() : kAperture.size()), ','))
      v.push_back(number(word).value_or(NAN));
  }
  const bool finite = std::all_of(v.begin(), v.end(), [](double x) { return std::isfinite(x); });
  const auto at = [&v](std::size_t first) { return Vec3{v[first], v[first + 1], v[first + 2]}; };
  if (finite && ray && v.size() == 6 && glm::length(at(3)) > 0.0)
    return beam_of(Ray{at(0), glm::normalize(at(3))}, radius);
  if (finite && !ray && v.size() == 7 && v[6] > 0.0 && at(0) != at(3))
    return beam_of(Aperture{at(0), at(3), v[6]});
  throw usage_error(option + " " + std::string(text) +
                    ": ray:x,y,z,dx,dy,dz from a place in a direction is expected, or "
                    "aperture:ex,ey,ez,ax,ay,az,s from an eye through a ring of radius s");
}

}  // namespace palpate
