/// What mouse and keys do to the probe: `G` or a held Shift grabs it, the mouse then moves it in the plane of
/// the view and the wheel along the view. Asked for from the panel, a click into the picture grabs it there,
/// and a drag holds it for as long as the button is down: what needs no key.
#pragma once

#include <optional>
#include <string>

#include "common/hand/probe_session.h"
#include "common/hand/technique/probe_mouse.h"
#include "common/render/scene_view.h"
#include "common/window/controls/view_control.h"
#include "common/window/input_event.h"
#include "common/window/keys.h"

namespace palpate {

class TouchControl {
 public:
  explicit TouchControl(ProbeSession& session) : session_(session) {}

  /// @param time [s] of a steady clock.  @param over_panel the mouse is over a panel, which takes what it
  /// does.
  /// @return whether the event was the probe's, and not for the camera.
  bool handle(const InputEvent& event, const PictureArea& area, const SceneView& view, double time,
              bool over_panel);
  /// @return what to say to the user, if the command is one about touch.
  std::optional<std::string> run(Command command, const PictureArea& area, const SceneView& view,
                                 double time);

  /// The mouse has hold of the probe; in a replay, that of the recording had.
  [[nodiscard]] bool grabbed() const noexcept { return grabbed_; }
  /// The next press into the picture grabs the probe.
  [[nodiscard]] bool waiting() const noexcept { return waiting_; }
  /// Whether clicks into the picture mark places for annotations.
  [[nodiscard]] bool marking() const noexcept { return marking_; }
  void mark(bool marking) noexcept { marking_ = marking; }
  /// The place of the volume under the mouse, which a click would mark; nothing while none would.
  [[nodiscard]] std::optional<Vec3> next_mark(const PictureArea& area, const SceneView& view);
  [[nodiscard]] std::optional<int> locked_axis() const noexcept { return session_.hand().intent().axis; }
  void let_go() noexcept;

 private:
  void grab(const PictureArea& area, const SceneView& view, double time);
  void grab_at(const Vec3& place, double time);
  bool mark_place(const PictureArea& area, const SceneView& view);
  bool take_hold(const PictureArea& area, const SceneView& view, double time);
  [[nodiscard]] Vec3 start_of_hand(const PictureArea& area, const SceneView& view) const;
  [[nodiscard]] std::optional<Vec3> end_of_tract(const PictureSize& size, const PicturePoint& mouse,
                                                 const Camera& camera) const;
  void lock(std::optional<int> axis) noexcept;
  std::string choose_mode(std::size_t mode);

  ProbeSession& session_;
  bool grabbed_ = false;
  bool by_shift_ = false;   ///< for as long as Shift is held
  bool waiting_ = false;    ///< asked for away from the picture: the next click into it grabs the probe there
  bool by_button_ = false;  ///< the press that grabbed the probe goes on
  bool marking_ = false;
  std::shared_ptr<const ScalarField> marked_;  ///< the field that marks have been placed in
  double threshold_ = 0.0;                     ///< between its object and its background
  bool holding_ = false;                       ///< the press holds a cutting plane, or the face of a box
  bool grabbed_to_hold_ = false;               ///< and has grabbed the probe for it
  bool dragged_ = false;                       ///< and has moved it
  double pressed_x_ = 0.0, pressed_y_ = 0.0;   ///< where it was [pixels]
  int buttons_ = 0;                            ///< that are down: the camera's then
  double x_ = 0.0, y_ = 0.0;                   ///< of the mouse [pixels]
  double moved_ = 0.0;                         ///< when it last moved the probe [s]
};

/// Where the probe starts when it is grabbed: on the line under the mouse, that of several which is in front;
/// else on the nearest one in the picture, and at the depth of the focal point where none is near.
[[nodiscard]] Vec3 start_of_probe(const SceneView& view, const PictureSize& size, const PicturePoint& mouse);

}  // namespace palpate
