/// Picking in space, of things that bounding balls stand for (Ikits 2006, sec. 3.2: what lies behind the
/// screen cannot be touched, and is picked by a ray or, more forgiving, through an aperture).
///
/// Symbols. c, r centre and radius of a ball; o, d origin and unit direction of a ray; e eye, a centre and s
/// radius of an aperture that the hand holds between the eye and what is picked.
///
///   ray        hits where |(c - o) x d| <= r and (c - o) . d + r >= 0; the first one along the ray counts
///   aperture   holds a ball that meets the cone from e through the circle of radius s about a, upright on
///              a - e; the one whose centre is nearest to the axis in angle counts, of two alike the nearer
///              (after Forsberg, Herndon, Zeleznik 1996, with the cone's axis in place of the hand's turn)
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "common/math/vec.h"

namespace palpate {

struct Ray {
  Vec3 origin{0.0};
  Vec3 direction{0.0, 0.0, -1.0};  ///< unit
};

/// What can be picked.
struct PickBall {
  Vec3 center{0.0};
  double radius = 0.0;  ///< >= 0
};

struct Aperture {
  Vec3 eye{0.0};
  Vec3 center{0.0, 0.0, -1.0};  ///< not at the eye
  double radius = 0.1;          ///< >= 0
};

/// Which one the ray hits first; none where it hits none.
[[nodiscard]] std::optional<std::size_t> pick_by_ray(const Ray& ray,
                                                     std::span<const PickBall> balls) noexcept;
/// Which one the aperture picks; none where none meets its cone.
[[nodiscard]] std::optional<std::size_t> pick_by_aperture(const Aperture& aperture,
                                                          std::span<const PickBall> balls) noexcept;

}  // namespace palpate
