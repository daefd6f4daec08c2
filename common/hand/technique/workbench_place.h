/// Where the data is at a workbench: the similarity from the tracker's frame to that of the data.
///
/// Symbols. q a place at the workbench [m], x the same in the data, q_0 and x_0 two that coincide, R a turn,
/// k data units a metre.
///
///   x = x_0 + k R (q - q_0)                                                                          (1)
///
/// The workbench file says where the middle of the data is shown, how it is turned and how large it is
/// (InteractionGeometry). In a window the camera says it: what the mouse does to it turns, moves and enlarges
/// the data before the screen, and screens, eyes and hands follow.
#pragma once

#include "common/geometry/screen.h"
#include "common/kinematics/workbench_file.h"
#include "common/math/quaternion.h"
#include "common/render/camera.h"

namespace palpate {

struct WorkbenchPlace {
  Vec3 data{0.0};       ///< x_0
  Vec3 workbench{0.0};  ///< q_0 [m]
  Quat turn{1.0, 0.0, 0.0, 0.0};
  double units = 1.0;  ///< k

  [[nodiscard]] Vec3 operator()(const Vec3& q) const noexcept {
    return data + units * (turn * (q - workbench));
  }
  /// The screen there, in data coordinates.
  [[nodiscard]] Screen operator()(const Screen& screen) const {
    return {(*this)(screen.lower_left), (*this)(screen.lower_right), (*this)(screen.upper_left)};
  }
};

/// As the workbench file says. @param middle of the data  @param scale metres of the workspace per data unit.
[[nodiscard]] WorkbenchPlace place_of(const InteractionGeometry& interaction, const Vec3& middle,
                                      double scale);

/// That by which `screen` is the rectangle that `camera` shows: its middle at the focal point, as high as the
/// view is there. @pre fault_of(screen) is empty.
[[nodiscard]] WorkbenchPlace place_of(const Camera& camera, const Screen& screen);

/// The camera of the screen, seen straight from before it: that of place_of() back again.
[[nodiscard]] Camera workbench_camera(const WorkbenchPlace& place, const Screen& screen);

}  // namespace palpate
