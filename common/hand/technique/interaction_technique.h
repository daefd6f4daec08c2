/// How hands move the probe: one interface for a mouse on a desktop and for tracked hands at an immersive
/// workbench (Ikits 2006, sec. 3.3). Each interprets what its devices say; whoever uses it sees only where
/// the hands want things. The workbench file says which one it is (calibration/workbench_file.h).
#pragma once

#include <optional>
#include <variant>

#include "common/device/tracked_hands.h"
#include "common/geometry/screen.h"
#include "common/hand/technique/probe_mouse.h"
#include "common/hand/technique/scene_pick.h"
#include "common/kinematics/workbench_file.h"
#include "common/math/quaternion.h"
#include "common/render/camera.h"

namespace palpate {

// Where the data is at a workbench: the similarity from the tracker's frame to that of the data.
//
// Symbols. q a place at the workbench [m], x the same in the data, q_0 and x_0 two that coincide, R a turn,
// k data units a metre.
//
//   x = x_0 + k R (q - q_0)                                                                          (1)
//
// The workbench file says where the middle of the data is shown, how it is turned and how large it is
// (InteractionGeometry). In a window the camera says it: what the mouse does to it turns, moves and enlarges
// the data before the screen, and screens, eyes and hands follow.

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

/// What the hands want. Data coordinates.
struct HandsIntent {
  Vec3 probe{0.0};
  bool acts = false;             ///< takes hold of what the probe is at
  std::optional<int> axis;       ///< along which alone the probe moves
  std::optional<Rigid> carried;  ///< how the other hand has moved what it holds since it took hold
  std::optional<Rigid> stylus;   ///< place of the probe and turn of a tracked stylus; none as `pointing`
  /// Where a tracked stylus points, from its tip; none where it is not seen, or there is none.
  std::optional<Ray> pointing;
};

/// What devices say: pixels that a mouse was moved by, notches of its wheel, an axis to be locked or none, or
/// where tracked hands are.
struct MouseDrag {
  double dx = 0.0, dy = 0.0;
};
struct WheelTurn {
  double notches = 0.0;
};
struct AxisLock {
  std::optional<int> axis;
};
using HandEvent = std::variant<MouseDrag, WheelTurn, AxisLock, TrackedHands>;

/// What is seen meanwhile.
struct HandsView {
  Camera camera;
  PictureSize size;
  std::optional<Vec3> held;  ///< the proxy, while something holds it
  /// Where the data is at the workbench; none: as its file says.
  std::optional<WorkbenchPlace> place;
};

class InteractionTechnique {
 public:
  InteractionTechnique() = default;
  InteractionTechnique(const InteractionTechnique&) = delete;
  InteractionTechnique& operator=(const InteractionTechnique&) = delete;
  virtual ~InteractionTechnique() = default;

  /// The probe is there from now on; the hands go on from where they are.
  virtual void put(const Vec3& probe) noexcept = 0;
  /// Whether the event was one for this technique.
  virtual bool take(const HandEvent& event, const HandsView& view) noexcept = 0;
  [[nodiscard]] const HandsIntent& intent() const noexcept { return intent_; }

 protected:
  HandsIntent intent_;
};

// A mouse moves the probe in the plane of the view, its wheel along the view, both along one axis if locked
// (probe_mouse.h). While a line holds the proxy the probe is moved from the proxy's depth, so that what is
// followed may lead away from the viewer; along surfaces it is led by whoever knows them (probe_mouse.h).

class DesktopTechnique final : public InteractionTechnique {
 public:
  void put(const Vec3& probe) noexcept override { intent_.probe = probe; }
  bool take(const HandEvent& event, const HandsView& view) noexcept override;
};

}  // namespace palpate
