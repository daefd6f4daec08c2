/// The closest point on an isosurface that is smooth in each of the boxes around it: Newton steps on the
/// surface, cut at the boxes' faces.
///
/// With d = x - p, g = grad s and H its Hessian, the minimum condition on the surface is d = lambda g, and
/// within the plane tangent to it, with basis Z, the step u solves
///
///   Z^T (1 + lambda H) Z u = Z^T d,   lambda = d . g / |g|^2                                          (1)
///
/// (the second-order condition of the Lagrangian |x - p|^2 / 2 + lambda (s - s_0)). Where the matrix is not
/// positive definite, which is where x is beyond the centre of curvature, the step goes along the projection
/// of d, or down the negative curvature where that vanishes. Each step ends on the surface again (eq. 6.16 of
/// Ikits 2006, along the gradient within the free axes, in a bracket) and must shorten the distance.
///
/// A point that lies on faces of the grid belongs to all boxes around. In each of them the steepest way down
/// is the projection of d on the cone of tangent directions that stay in the box; the steepest of all is
/// taken. So a crease between two boxes is followed along its curve in the face, and a point held by a crease
/// or a corner has no way down in any box.
///
/// All of this in coordinates y along the boxes' axes. Where these are at no right angles, x = B y, lengths are
/// those of the metric M = B^T B, gradients turn into directions by its inverse (axes_metric.h), and (1) reads
/// Z^T (M + lambda H) Z u = Z^T M d with Z^T M Z = 1.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "common/math/vec.h"
#include "common/trace/isosurface/axes_metric.h"
#include "common/trace/isosurface/isosurface.h"

namespace palpate {

/// `Boxes` gives `Boxes::Patch`, a copy of one box's formula with `lower`, `upper`, value(), gradient() and
/// hessian(), and
///   bool visit(const Vec3& p, Visit visit)   calls visit(const Patch&) for each box of good data that p
///   touches;
///                                            false if it also touches bad data
///   double reach()                           no step is longer than this
///   const AxesMetric& metric()               of the coordinates
template <class Boxes>
class SurfaceDescent {
 public:
  using Patch = typename Boxes::Patch;

  SurfaceDescent(const Boxes& boxes, const IsosurfaceScale& scale, double level, SearchWork& work) noexcept
      : boxes_(boxes), metric_(boxes.metric()), scale_(scale), level_(level), work_(work) {}

  /// Moves `position` to the local minimum of the distance from `x`.
  [[nodiscard]] SurfaceFit settle(const Vec3& x, Vec3& position) noexcept {
    SurfaceFit fit;
    Way way = look(position, x);
    if (way.found && std::abs(way.patch.value(position) - level_) > scale_.value) {
      // The point was made by somebody else: first of all on to the surface.
      Vec3 back = position;
      if (restore(way.patch, kAll, boxes_.reach(), back) && inside(way.patch, back)) {
        position = back;
        way = look(position, x);
      }
    }
    if (way.found) {
      // Somebody else may have left it beside a face, too.
      Vec3 put = position;
      put_on_faces(way.patch, off_faces(way.patch, position), put);
      if (put != position) {
        position = put;
        way = look(position, x);
      }
    }
    for (;;) {
      if (!way.found) {
        fit.end = way.bad ? SurfaceEnd::kBadData : SurfaceEnd::kFlat;
        return fit;
      }
      const Vec3 d = x - position;
      const bool level = way.size() <= still(d);
      if (level && !(way.least_curvature() < 0.0)) break;
      if (!(level ? step_off(way, x, position) : step_down(way, x, position))) {
        // A way down that no step can take, by more than rounding: the surface has a singular point here.
        constexpr double kRounding = 0x1p-20;
        if (way.size() > kRounding * metric_.length(d)) {
          fit.end = work_.spent() ? SurfaceEnd::kBudget : SurfaceEnd::kFlat;
        }
        break;
      }
    }
    if (way.bad && fit.end == SurfaceEnd::kClosest) fit.end = SurfaceEnd::kBadData;
    fit.gradient = way.gradient;
    fit.error = way.patch.value(position) - level_;
    fit.toward = way.toward;
    fit.jacobian = metric_.lowered(way.jacobian());
    return fit;
  }

 private:
  static constexpr unsigned kAll = 7;  ///< axes, a bit each
  static constexpr double kQuarter = 0.25;

  [[nodiscard]] static unsigned without(unsigned free, int axis) noexcept {
    return free & ~(1U << static_cast<unsigned>(axis));
  }
  [[nodiscard]] static bool has(unsigned free, int axis) noexcept {
    return ((free >> static_cast<unsigned>(axis)) & 1U) != 0;
  }

  /// Below this a way down is rounding: the direction of the force is then right to 2^-38.
  [[nodiscard]] double still(const Vec3& d) const noexcept {
    return 0x1p-38 * metric_.length(d) + scale_.distance;
  }
  [[nodiscard]] static bool inside(const Patch& patch, const Vec3& p) noexcept {
    return glm::all(glm::greaterThanEqual(p, patch.lower)) && glm::all(glm::lessThanEqual(p, patch.upper));
  }
  /// The axes along which `p` lies on no face of the box.
  [[nodiscard]] static unsigned off_faces(const Patch& patch, const Vec3& p) noexcept {
    unsigned free = kAll;
    for (int axis = 0; axis < 3; ++axis) {
      if (p[axis] == patch.lower[axis] || p[axis] == patch.upper[axis]) free = without(free, axis);
    }
    return free;
  }
  /// Whether `direction` leads out of the box by a face that `p` lies on.
  [[nodiscard]] static bool leaves(const Patch& patch, const Vec3& p, const Vec3& direction) noexcept {
    for (int axis = 0; axis < 3; ++axis) {
      if (direction[axis] < 0.0 && p[axis] <= patch.lower[axis]) return true;
      if (direction[axis] > 0.0 && p[axis] >= patch.upper[axis]) return true;
    }
    return false;
  }

  /// The steepest way down from a point, and how the distance bends there.
  struct Way {
    Patch patch{};  ///< the box that it leads into
    Vec3 gradient{0.0};
    Vec3 down{0.0};        ///< projection of d on the directions that are open
    double square = -1.0;  ///< of `down`
    unsigned free = kAll;  ///< the axes that it may lead along; a face fixes the others
    int rank = 2;          ///< dimension in which the point can move: surface, crease or corner
    double toward = 0.0;   ///< as in SurfaceFit
    bool found = false;
    bool bad = false;
    Vec3 first{0.0}, second{0.0};      ///< Z, its first column along `down`
    double a = 1.0, b = 1.0, c = 0.0;  ///< the matrix of (1): (a c; c b)

    [[nodiscard]] double size() const noexcept { return std::sqrt(std::max(square, 0.0)); }
    [[nodiscard]] double least_curvature() const noexcept {
      if (rank == 0) return 1.0;
      return rank == 1 ? a : 0.5 * (a + b) - std::hypot(0.5 * (a - b), c);
    }
    /// Z (a c; c b)^-1 Z^T, the identity in place of a matrix that is not positive definite.
    [[nodiscard]] Mat3 jacobian() const noexcept {
      const bool definite = least_curvature() > 0.0;
      if (rank == 0) return Mat3{0.0};
      if (rank == 1) return glm::outerProduct(first, first) * (definite ? 1.0 / a : 1.0);
      if (!definite) return glm::outerProduct(first, first) + glm::outerProduct(second, second);
      const double inverse = 1.0 / (a * b - c * c);
      const Mat3 mixed = glm::outerProduct(first, second);
      return (glm::outerProduct(first, first) * b + glm::outerProduct(second, second) * a -
              (mixed + glm::transpose(mixed)) * c) *
             inverse;
    }
  };

  /// Looks around `p` for the steepest way down to `x`.
  [[nodiscard]] Way look(const Vec3& p, const Vec3& x) const noexcept {
    Way best;
    const Vec3 d = x - p;
    bool entered = false;
    double toward = 0.0;
    best.bad = !boxes_.visit(p, [&](const Patch& patch) {
      const Vec3 g = patch.gradient(p);
      const Vec3 rise = glm::abs(g * (patch.upper - patch.lower));
      if (!(std::max({rise.x, rise.y, rise.z}) > scale_.flat)) return;
      if (!leaves(patch, p, d)) {
        entered = true;
        toward = glm::dot(g, d);
      }
      consider(patch, p, d, g, best);
    });
    if (!best.found) return best;
    best.toward = entered ? toward : glm::dot(best.gradient, d);
    bend(p, d, best);
    return best;
  }

  /// Projects `d` on the directions that stay on the surface and in the box; keeps the longest projection.
  void consider(const Patch& patch, const Vec3& p, const Vec3& d, const Vec3& g, Way& best) const noexcept {
    const auto keep = [&](const Vec3& down, unsigned free, int rank) {
      const double square = metric_.dot(down, down);
      if (square <= best.square) return;
      best.patch = patch;
      best.gradient = g;
      best.down = down;
      best.square = square;
      best.free = free;
      best.rank = rank;
      best.found = true;
    };
    const Vec3 steepest = metric_.raised(g, kAll);
    const double slope2 = glm::dot(g, steepest);
    const Vec3 down = d - steepest * (glm::dot(d, g) / slope2);
    if (!leaves(patch, p, down)) {
      keep(down, kAll, 2);
      return;
    }
    keep(Vec3{0.0}, kAll, metric_.dot(down, down) > still(d) * still(d) ? 0 : 2);
    for (int axis = 0; axis < 3; ++axis) {
      if (p[axis] > patch.lower[axis] && p[axis] < patch.upper[axis]) continue;
      const unsigned free = without(kAll, axis);
      const Vec3 face_g = metric_.raised(g, free), face_d = metric_.projected(d, free);
      const double face2 = glm::dot(g, face_g);
      constexpr double kTouches = 0x1p-60;  // the surface only touches the face
      if (!(face2 > kTouches * slope2)) continue;
      const Vec3 along = face_d - face_g * (glm::dot(face_d, g) / face2);
      if (!leaves(patch, p, along)) keep(along, free, 1);
    }
  }

  /// The matrix of (1) at `p`.
  void bend(const Vec3& p, const Vec3& d, Way& way) const noexcept {
    if (way.rank == 0) return;
    const Vec3 g = metric_.raised(way.gradient, way.free);
    const double slope2 = metric_.dot(g, g);
    const Vec3 normal = g / std::sqrt(slope2);
    const Mat3 hessian = way.patch.hessian(p);
    const double lambda = metric_.dot(d, g) / slope2;
    constexpr double kRounding = 0x1p-40;
    if (way.size() > kRounding * metric_.length(d)) {
      way.first = metric_.unit(way.down - normal * metric_.dot(way.down, normal));
    } else {  // any tangent: that of the axis farthest from the normal
      const Vec3 across = metric_.lowered(normal);
      Vec3 axis{0.0};
      double least = HUGE_VAL;
      for (int i = 0; i < 3; ++i) {
        if (!has(way.free, i) || std::abs(across[i]) >= least) continue;
        least = std::abs(across[i]);
        axis = Vec3{0.0};
        axis[i] = 1.0;
      }
      way.first = metric_.unit(axis - normal * glm::dot(axis, across));
    }
    const auto bent = [&](const Vec3& v) { return metric_.lowered(v) + lambda * (hessian * v); };
    way.a = glm::dot(way.first, bent(way.first));
    if (way.rank == 1) return;
    way.second = metric_.across(normal, way.first);
    way.b = glm::dot(way.second, bent(way.second));
    way.c = glm::dot(way.second, bent(way.first));
  }

  /// A step down: Newton's, else along the projection of d. False where none shortens the distance.
  [[nodiscard]] bool step_down(Way& way, const Vec3& x, Vec3& position) noexcept {
    constexpr double kDefinite = 0x1p-4;  // below, Newton's step is many times too long
    constexpr int kNewtonTrials = 3, kTrials = 8;
    if (way.least_curvature() > kDefinite) {
      // (a c; c b) u = (|down|, 0).
      const double determinant = way.a * way.b - way.c * way.c;
      const Vec3 newton = way.rank == 1
                              ? way.down / way.a
                              : (way.first * way.b - way.second * way.c) * (way.size() / determinant);
      if (!leaves(way.patch, position, newton) && shorten(way, newton, kNewtonTrials, x, position))
        return true;
    }
    return shorten(way, way.down, kTrials, x, position);
  }

  /// A step from a point that is level, but no minimum: down the negative curvature.
  [[nodiscard]] bool step_off(Way& way, const Vec3& x, Vec3& position) noexcept {
    constexpr double kPart = 0x1p-4;
    constexpr int kTrials = 4;
    Vec3 direction = way.first;
    if (way.rank == 2) {
      const double angle = 0.5 * std::atan2(2.0 * way.c, way.a - way.b);  // of the larger curvature
      direction = way.second * std::cos(angle) - way.first * std::sin(angle);
    }
    const Vec3 move = direction * (kPart * boxes_.reach());
    return shorten(way, move, kTrials, x, position) || shorten(way, -move, kTrials, x, position);
  }

  /// Tries `move`, and smaller and smaller parts of it, until the distance from `x` falls.
  [[nodiscard]] bool shorten(Way& way, Vec3 move, int trials, const Vec3& x, Vec3& position) noexcept {
    const double length = metric_.length(move);
    if (length > boxes_.reach()) move *= boxes_.reach() / length;
    const Vec3 d = x - position;
    const double noise = 4.0 * scale_.distance * (metric_.length(d) + scale_.distance);
    for (int trial = 0; trial < trials && work_.take(); ++trial, move *= kQuarter) {
      Vec3 next;
      if (!travel(way.patch, way.free, position, move, next)) continue;
      const Vec3 moved = next - position;
      // |x - p|^2 - |x - next|^2, without cancellation.
      const double gain = metric_.dot(moved, 2.0 * d - moved);
      if (gain < -noise) continue;
      const Way ahead = look(next, x);
      // Close to the minimum the distance cannot tell any more: the slope must halve.
      if (gain <= noise && !(ahead.found && ahead.size() <= 0.5 * way.size())) continue;
      position = next;
      way = ahead;
      return true;
    }
    return false;
  }

  /// From `from` along `move` and back on to the surface, at most to a face of the box.
  [[nodiscard]] bool travel(const Patch& patch, unsigned free, const Vec3& from, const Vec3& move,
                            Vec3& to) const noexcept {
    to = from + metric_.projected(move, free);
    for (;;) {
      // The first face that the way to `to` leaves by.
      double part = 1.0;
      int out = -1;
      for (int axis = 0; axis < 3; ++axis) {
        const double bound = to[axis] < from[axis] ? patch.lower[axis] : patch.upper[axis];
        const bool beyond = to[axis] < patch.lower[axis] || to[axis] > patch.upper[axis];
        if (!beyond) continue;
        const double at = (bound - from[axis]) / (to[axis] - from[axis]);
        if (at < part || out < 0) {
          part = at;
          out = axis;
        }
      }
      if (out >= 0) {
        free = without(free, out);
        if (free == 0) return false;
        const double bound = to[out] < from[out] ? patch.lower[out] : patch.upper[out];
        // On the face from the beginning: along it, since the surface bends away behind it.
        to = part > 0.0 ? from + part * (to - from) : from + metric_.projected(move, free);
        to[out] = bound;
        continue;
      }
      const double reach = std::max(metric_.length(to - from), scale_.distance);
      if (!restore(patch, free, reach, to)) return false;
      if (inside(patch, to)) break;
    }
    put_on_faces(patch, free, to);
    return true;
  }

  /// A point beside a face to rounding is put on it, so that both boxes are asked; a point of an edge beside
  /// its end on the vertex, where the surface goes through that.
  void put_on_faces(const Patch& patch, unsigned free, Vec3& p) const noexcept {
    constexpr double kOnFace = 0x1p-40;
    for (int axis = 0; axis < 3; ++axis) {
      if (!has(free, axis)) continue;
      const double width = patch.upper[axis] - patch.lower[axis];
      const bool low = p[axis] - patch.lower[axis] < kOnFace * width;
      if (!low && patch.upper[axis] - p[axis] >= kOnFace * width) continue;
      Vec3 put = p;
      put[axis] = low ? patch.lower[axis] : patch.upper[axis];
      const unsigned rest = without(free, axis);
      if (!restore(patch, rest, width, put) || !inside(patch, put)) continue;
      p = put;
      free = rest;
    }
  }

  /// Brings `p` to the level along its gradient within the free axes: Newton's steps (Ikits 2006, eq. 6.16),
  /// in a bracket as soon as there is one. False where there is no root within `farthest`.
  [[nodiscard]] bool restore(const Patch& patch, unsigned free, double farthest, Vec3& p) const noexcept {
    const Vec3 slope = metric_.raised(patch.gradient(p), free);
    const double length = metric_.length(slope);
    if (!(length > 0.0)) return std::abs(patch.value(p) - level_) <= scale_.value;
    const Vec3 direction = slope / length;
    const Vec3 origin = p;
    double at = 0.0, f = patch.value(p) - level_, rate = length;
    double low = -farthest, high = farthest;  // a root lies between, if any
    constexpr int kSteps = 60;
    for (int step = 0; step < kSteps && std::abs(f) > scale_.value; ++step) {
      // s rises along the direction at the origin: below the level the root is ahead.
      (f < 0.0 ? low : high) = at;
      double next = at - f / rate;
      if (!(rate > 0.0) || !(next > low && next < high)) next = 0.5 * (low + high);
      if (next == at || next == low || next == high) break;
      at = next;
      p = origin + at * direction;
      f = patch.value(p) - level_;
      rate = glm::dot(patch.gradient(p), direction);
    }
    // Without a change of sign the steps have run into an end of the range.
    constexpr double kMissed = 0x1p10;
    return std::abs(f) <= kMissed * scale_.value;
  }

  const Boxes& boxes_;
  const AxesMetric& metric_;
  const IsosurfaceScale& scale_;
  double level_;
  SearchWork& work_;
};

}  // namespace palpate
