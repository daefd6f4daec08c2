/// How hands move the probe: one interface for a mouse on a desktop and for tracked hands at an immersive
/// workbench (Ikits 2006, sec. 3.3). Each interprets what its devices say; whoever uses it sees only where
/// the hands want things. The workbench file says which one it is (calibration/workbench_file.h).
#pragma once

#include <optional>
#include <variant>

#include "common/device/tracked_hands.h"
#include "common/hand/technique/pick.h"
#include "common/hand/technique/probe_mouse.h"
#include "common/hand/technique/workbench_place.h"
#include "common/math/quaternion.h"

namespace palpate {

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

}  // namespace palpate
