/// Two eyes before one picture: where they are, how far apart, and how a display tells them apart.
///
/// Symbols.  e eye separation, d distance between eyes and screen, z depth of a point from the eyes, all in
/// one unit; the screen is the plane through the focal point.
///
/// A point straight ahead at depth z is seen with the vergence 2 atan(e / 2z). Its angular disparity is that
/// against a point of the screen,
///   eta(z) = 2 atan(e / 2z) - 2 atan(e / 2d)                                                 (1)
/// positive before the screen. With a = e / 2 and t = tan(|eta| / 2) the addition theorem gives
///   t a^2 / (z d) - |1/z - 1/d| a + t = 0                                                    (2)
/// whose smaller root is the separation at which eta is reached. Eyes are held within it, so that all of the
/// scene can be fused (Ikits 2006, sec. 4.1; one degree either way: Lambooij, Fortuin, Heynderickx,
/// IJsselsteijn 2009).
#pragma once

#include <array>
#include <cmath>
#include <optional>

#include "common/base/check.h"
#include "common/geometry/screen.h"
#include "common/math/vec.h"
#include "common/render/camera.h"

namespace palpate {

struct StereoView {
  StereoMode mode = StereoMode::kNone;
  double separation = 0.105;                 ///< e / d that is wanted, >= 0: 63 mm before a screen at 600 mm
  double most_disparity = 0.01745329251994;  ///< |eta| that can be fused [rad], > 0
  bool swapped = false;                      ///< the left eye's picture where the right one's belongs
  /// Column and row of the display that the picture's upper left pixel is shown at: a display tells the eyes
  /// apart by its own rows or columns, wherever a window lies on it.
  std::array<int, 2> first{0, 0};

  /// Of a tracked head: left, right [data units], before the camera's focal plane, which is the screen. Then
  /// `separation` says nothing.
  std::optional<std::array<Vec3, 2>> eyes;

  bool operator==(const StereoView&) const = default;
};

/// (1) [rad]. @pre z > 0, d > 0.
[[nodiscard]] double angular_disparity(double separation, double z, double d) noexcept;

/// The smaller root of (2), doubled: the least e > 0 with |eta(z)| = `disparity`; infinite where none reaches
/// it. @pre z > 0, d > 0, 0 < disparity < pi.
[[nodiscard]] double separation_of_disparity(double disparity, double z, double d) noexcept;

/// Where the eyes of a picture are. Depths in data units.
struct StereoEyes {
  std::array<Camera, 2> cameras;                     ///< left, right: not swapped
  double separation = 0.0;                           ///< e / d that they have
  double limited = 1.0;                              ///< that over the one that was wanted
  double near_depth = 0.0, far_depth = 0.0;          ///< z between which the scene lies
  double near_disparity = 0.0, far_disparity = 0.0;  ///< (1) there [rad]
};

/// Cameras of both eyes, moved apart along the camera's right axis, or where those of a tracked head are,
/// with e as wanted or as the depths of `bounds` allow: then both are moved towards the point between them.
/// @pre the camera is a perspective one, and both eyes are before its focal plane.
[[nodiscard]] StereoEyes stereo_eyes(const Camera& camera, const StereoView& stereo, const Box& bounds);

/// What each eye gets of a picture.
struct EyePictureSize {
  int width = 0, height = 0;
};
/// @throws Error (usage) where nothing is left for an eye.
[[nodiscard]] EyePictureSize eye_picture_size(StereoMode mode, int width, int height);

/// Width / height of it.
[[nodiscard]] double eye_aspect(StereoMode mode, double width, double height) noexcept;

/// The camera whose picture's rectangle is the screen, of an eye straight before its middle.
/// @pre fault_of(screen) is empty; all in data coordinates.
[[nodiscard]] inline Camera screen_camera(const Screen& screen) {
  Camera camera;
  camera.focal_point = center(screen);
  camera.axes = axes(screen);
  camera.view_height = height(screen);
  return camera;
}

/// Moves the eye of a perspective camera to `eye` and leaves the picture's rectangle on the focal plane where
/// it is.
/// @pre the eye is before that plane: glm::dot(eye - focal_point, axes[2]) > 0.
[[nodiscard]] inline Camera seen_from(const Camera& camera, const Vec3& eye) {
  const Vec3 v = (eye - camera.focal_point) * camera.axes;  // along right, up, back
  PALPATE_CHECK(v.z > 0.0);
  Camera moved = camera;
  moved.field_of_view = 2.0 * std::atan(0.5 * camera.view_height / v.z);
  moved.eye_offset = {v.x, v.y};
  return moved;
}

}  // namespace palpate
