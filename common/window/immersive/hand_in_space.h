/// What a tracked stylus or a device in the hand does beside feeling the data: it works the menu in space,
/// and where it points at none of that, picks what is in the scene. One of both at a time; it picks nothing
/// while it is at a cutting plane that it can touch, nor on a haptic grid, whose button takes hold of what is
/// there.
#pragma once

#include <optional>
#include <string>

#include "common/window/controls/pick_control.h"
#include "common/window/immersive/menu_hand.h"

namespace palpate {

class HandInSpace {
 public:
  /// Once a frame, before the session's update.
  /// @param seeing the view's camera with the eye that looks at the hand  @param time [s] as of
  /// ProbeSession::grab().
  /// @return what to say to the user.
  std::optional<std::string> follow(MenuControl& menu, ProbeSession& touch, SceneView& view,
                                    const Camera& seeing, const PictureArea& area, double time);
  /// What is pointed at in the scene, or held.
  [[nodiscard]] const std::optional<Picked>& picked() const noexcept { return pick_.picked(); }
  /// Whether lenses or planes are moved from afar.
  [[nodiscard]] bool holding() const noexcept { return pick_.holding(); }

 private:
  MenuHand menu_;
  PickControl pick_;
};

}  // namespace palpate
