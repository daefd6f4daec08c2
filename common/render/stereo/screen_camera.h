/// Cameras that make a screen a window into the scene: off-axis frusta through its edges (Kooima 2009,
/// "Generalized perspective projection").
#pragma once

#include "common/geometry/screen.h"
#include "common/render/camera.h"

namespace palpate {

/// The camera whose picture's rectangle is the screen, of an eye straight before its middle.
/// @pre fault_of(screen) is empty; all in data coordinates.
[[nodiscard]] Camera screen_camera(const Screen& screen);

/// Moves the eye of a perspective camera to `eye` and leaves the picture's rectangle on the focal plane where
/// it is.
/// @pre the eye is before that plane: glm::dot(eye - focal_point, axes[2]) > 0.
[[nodiscard]] Camera seen_from(const Camera& camera, const Vec3& eye);

}  // namespace palpate
