/// The hand on the probe and the menu in space: a device in the hand points at it as the eye sees its tip,
/// and feels the way and the detents of a slider or knob that it holds (Ikits 2006, sec. 3.2). So does the
/// hand that a mouse leads.
///
/// Symbols. e eye, x tip of the hand, c the place of the menu on the ray from e through x. What is held there
/// is felt where the hand is: its way, seen from e, at the depth of the hand, by the factor
///   s = (x - e).n / (c - e).n,   n the normal of the menu                                              (1)
/// so that hand and handle go together in the picture. s stays as it was when it was taken.
#pragma once

#include <optional>

#include "common/hand/probe_session.h"
#include "common/window/immersive/menu_control.h"

namespace palpate {

class MenuHand {
 public:
  /// Once a frame, before the session's update. @param time [s] as of ProbeSession::grab().
  /// @return whether the hand works the menu: it is to be engaged with that.
  [[nodiscard]] bool follow(MenuControl& menu, ProbeSession& touch, const Camera& camera,
                            const PictureArea& area, double time);

 private:
  void lead_by_mouse(MenuControl& menu, ProbeSession& touch, const Camera& camera, const PictureArea& area,
                     double time);

  std::optional<double> depth_;  ///< s of (1), while a device holds something
  bool led_ = false;             ///< by the mouse, on the menu
  bool arrived_ = false;         ///< and the arm that follows it is there
  std::optional<Vec3> back_;     ///< where the mouse had the probe before
};

/// The same slider or knob as `camera` sees it, at s times the distance: (1). In an orthographic view, where
/// it is `shift` nearer to the viewer.
[[nodiscard]] Dial seen_at(const Dial& dial, const Camera& camera, double s, double shift);

}  // namespace palpate
