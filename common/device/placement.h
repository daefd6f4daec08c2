/// How a device in the hand lies over the workspace: where its middle is, which way it faces, and the plane
/// that it moves on alone, where there is one.
#pragma once

#include <optional>

#include "common/math/vec.h"

namespace palpate {

/// x_W = middle + scale axes P(x_D),   P(x) = x - (n.x - d) n, or x where there is no plane. The axes are
/// those of the view, so that right, up and towards the user are the same for the hand and the eye.
struct Placement {
  Vec3 middle{0.0};    ///< [m] in W
  Mat3 axes{1.0};      ///< columns: right, up, towards the user, in W; orthonormal
  double scale = 1.0;  ///< metres of W for one of the hand, > 0
  /// (n, d): n.x_D = d [m], |n| = 1. Forces across it have nothing to act on: P^T F is what the hand gets.
  std::optional<Vec4> surface;

  /// P.
  [[nodiscard]] Vec3 on_surface(const Vec3& x) const noexcept {
    if (!surface) return x;
    const Vec3 n{*surface};
    return x - (glm::dot(n, x) - surface->w) * n;
  }

  bool operator==(const Placement&) const = default;
};

}  // namespace palpate
