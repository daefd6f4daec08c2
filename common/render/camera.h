/// The camera: looks at a focal point, turns about it, and fits a box. Double precision, data units.
///
/// Symbols.  f focal point; (r, u, b) unit axes right, up and back (toward the viewer), right-handed;
/// h height of the view at the focal point [data units]; alpha vertical field of view; d distance.
///
///   d = h / (2 tan(alpha / 2))        eye = f + d b + o_x r + o_y u                      (1)
///
/// so that a perspective and an orthographic view of the same h show the focal plane at the same size. An
/// offset o of the eye leaves the picture's rectangle on the focal plane where it is: the frustum becomes an
/// off-axis one, that of one of two eyes, or of a head before a screen. Every operation is a rotation or a
/// product with h: scaling the data by a power of two scales f and h exactly and leaves the picture as it is.
#pragma once

#include <cstdint>

#include "common/math/vec.h"

namespace palpate {

enum class Projection : std::uint8_t { kPerspective, kOrthographic };

struct Camera {
  Vec3 focal_point{0.0};
  Mat3 axes{1.0};            ///< columns r, u, b in data coordinates, orthonormal
  double view_height = 2.0;  ///< h > 0
  Projection projection = Projection::kPerspective;
  double field_of_view = 0.5235987755982988;  ///< alpha [rad], 30 degrees
  Vec2 eye_offset{0.0};  ///< o, along r and u [data units]; perspective alone, where a picture is drawn

  bool operator==(const Camera&) const = default;
};

/// A view of a box as `--camera azimuth,elevation,roll,zoom` states it. The z axis of the data points up;
/// azimuth 0 looks along +y with x to the right, and turns the viewer about z, counter-clockwise seen
/// from above; elevation raises the viewer; roll turns the picture counter-clockwise. [degrees]
struct CameraAngles {
  double azimuth = 30.0;
  double elevation = 20.0;
  double roll = 0.0;
  double zoom = 1.0;  ///< > 0; 1 fits the box
};

/// The camera that sees all of `bounds` (an empty or degenerate box: something sensible around it).
/// @param aspect width / height of the picture.
[[nodiscard]] Camera make_camera(const Box& bounds, const CameraAngles& angles, double aspect,
                                 Projection projection = Projection::kPerspective);

/// Changes focal point and height so that all of `bounds` is seen; keeps the direction of view.
void fit(Camera& camera, const Box& bounds, double aspect);

/// Turns about the focal point as if the scene were a ball under the mouse: `to_right` about the
/// camera's up axis, `to_top` about its right axis [rad].
void turn(Camera& camera, double to_right, double to_top);
/// Turns the picture counter-clockwise [rad].
void roll(Camera& camera, double angle);
/// Moves the scene under the camera by fractions of the view's height.
void pan(Camera& camera, double to_right, double to_top);
/// Enlarges the picture by `factor` > 0, about the point that `to_right`, `to_top` (fractions of the
/// view's height from its middle) show.
void zoom(Camera& camera, double factor, double to_right = 0.0, double to_top = 0.0);

[[nodiscard]] double distance(const Camera& camera) noexcept;  ///< d of (1)
/// Of (1); orthographic: without o.
[[nodiscard]] Vec3 eye(const Camera& camera) noexcept;
/// Nearer to the eye than this part of d nothing is drawn in perspective.
inline constexpr double kNearestDepth = 0.01;

/// Scene frame N of the GPU: x_N = 2^-exponent (x_X - center). Coordinates are near one whatever the
/// data's units and origin, so that single precision is enough.
struct SceneFrame {
  Vec3 center{0.0};
  int exponent = 0;

  [[nodiscard]] Vec3 scene_from_data(const Vec3& x) const noexcept;
};
/// The frame of a box: centred, with half its longest side in [1/2, 1).
[[nodiscard]] SceneFrame scene_frame(const Box& bounds) noexcept;

/// What a picture needs of a camera, in the scene frame.
struct ViewTransform {
  Mat4 clip_from_scene{1.0};
  Vec3 eye{0.0};             ///< scene frame
  Vec2 eye_offset{0.0};      ///< o of (1), scene units; 0 in an orthographic view
  Vec3 focal_point{0.0};     ///< scene frame
  double distance = 1.0;     ///< scene units
  double view_height = 2.0;  ///< scene units
  double near_depth = 0.0;   ///< depths along the view between which the scene lies
  double far_depth = 1.0;
};
[[nodiscard]] ViewTransform view_transform(const Camera& camera, const SceneFrame& frame, const Box& bounds,
                                           double aspect);

/// Where a point is drawn: x to the right and y down in pixels from the top left corner, z the depth
/// along the view in data units (perspective: from the eye; orthographic: from a plane at distance d).
/// Behind the eye z is not positive, and x and y mean nothing.
[[nodiscard]] Vec3 project(const Camera& camera, const Vec3& x, int width, int height) noexcept;

}  // namespace palpate
