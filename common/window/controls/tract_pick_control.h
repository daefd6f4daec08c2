/// Picks tracts by the mouse: while it is on, a left press over the picture or a slice asks for the tract there. Which one
/// that is the panel finds out, which knows the bundles. Plain arithmetic, no window.
#pragma once

#include <optional>
#include <utility>

#include "common/hand/technique/scene_pick.h"
#include "common/math/vec.h"
#include "common/window/controls/view_control.h"
#include "common/window/input_event.h"

namespace palpate {

/// Where a tract is asked for.
struct TractPick {
  PickBeam beam;              ///< from the eye through the mouse, or the same of a slice
  std::optional<Vec3> place;  ///< under the mouse on a slice beside the picture; none: over the picture
};

class TractPickControl {
 public:
  bool on = false;  ///< chosen in the panel

  /// @param area that the event is over, seen by `camera`. @param place as TractPick::place.
  /// @return whether the event was for the control.
  bool handle(const InputEvent& event, const PictureArea& area, const Camera& camera,
              const std::optional<Vec3>& place);
  /// The last press, once.
  [[nodiscard]] std::optional<TractPick> take() noexcept { return std::exchange(asked_, std::nullopt); }
  void let_go() noexcept { held_ = false; }

 private:
  std::optional<TractPick> asked_;
  bool held_ = false;
};

/// What a mouse at `mouse`, in pixels from the upper left corner of the picture, points at. @param pixels that it may miss by.
[[nodiscard]] PickBeam beam_under_mouse(const Camera& camera, const PictureSize& size,
                                        const PicturePoint& mouse, double pixels);

}  // namespace palpate
