/// What mouse, keys and hands do in the picture. Each event goes to the first control that takes it: panes of
/// slices, the menu in space, the region of interest, pictures on planes, lenses, the probe, slices, and last the camera.
#pragma once

#include <optional>
#include <string>
#include <utility>

#include "common/hand/technique/box_hold.h"
#include "common/hand/workbench/workbench_display.h"
#include "common/window/controls/brush_control.h"
#include "common/window/controls/color_lens_control.h"
#include "common/window/controls/lens_control.h"
#include "common/window/controls/pane_control.h"
#include "common/window/controls/plane_image_control.h"
#include "common/window/controls/pointer.h"
#include "common/window/controls/region_control.h"
#include "common/window/controls/slice_control.h"
#include "common/window/controls/touch_control.h"
#include "common/window/controls/tract_pick_control.h"
#include "common/window/controls/view_control.h"
#include "common/window/immersive/hand_in_space.h"
#include "common/window/immersive/menu_control.h"

namespace palpate {

/// What the controls work on, this frame.
struct ControlledScene {
  const SceneState* scene = nullptr;  ///< null until the first one is there
  SceneView& view;
  PictureArea picture;  ///< the pane of the volume, where there are slices beside it
  PictureArea panes;    ///< all of them
  /// Shows the data as a screen of a workbench does to the head before it; null: a desktop.
  const WorkbenchDisplay* workbench = nullptr;
  bool beside_screens = false;  ///< these are windows of their own, and this one is a desktop
  double time = 0.0;            ///< [s] of a steady clock

  /// A volume is all that is looked at, and may be cropped: that of tensors is made of them, that of a flow
  /// has lines in it.
  [[nodiscard]] bool has_region() const { return view.volume && scene && scene->is_volume_alone(); }
  /// A heart's layer is shown.
  [[nodiscard]] bool has_layer() const { return scene && scene->info->layers; }
};

class SceneControls {
 public:
  /// `touch` outlives it. @param region of interest at the start.
  SceneControls(ProbeSession& touch, const std::optional<Box>& region);

  /// Once a frame, before its events: where the picture lies and the menu in it. @param two eyes see it.
  void place(const ControlledScene& on, bool two);
  /// The mouse goes on, whatever the event is for.
  void follow_pointer(const InputEvent& event, const ControlledScene& on) {
    pointer_.follow(event);
    pane_control_.follow(event, on.panes, on.view.volume ? &*on.view.volume : nullptr);
  }
  /// @param over_panel the mouse is over a panel, to which presses are. @param in_text keys are typed into a
  /// field. @return what to tell the user; nothing where nothing is to be said.
  std::optional<std::string> handle(const InputEvent& event, const ControlledScene& on, bool over_panel,
                                    bool in_text);
  /// Lenses, the region's corner, axes to look along, slices, the probe.
  /// @return what to tell the user, where the command was one of these.
  std::optional<std::string> run(Command command, const ControlledScene& on);
  /// Of everything that is being dragged or moved.
  void let_go();

  /// Once a frame, after its events: what a stylus or a device does to the menu, and picks in the scene.
  /// @return what to tell the user.
  std::optional<std::string> work_in_space(const ControlledScene& on);
  /// A hand on a haptic grid takes hold of the faces of the region of interest, else of the view.
  void lead_by_grid(const ControlledScene& on);
  /// Shows the menu in space, or takes it away.
  void toggle_menu(const ControlledScene& on);
  /// From now on that lens follows the mouse. @return what to tell the user.
  std::string follow_lens(std::size_t lens) { return lens_.follow(lens); }
  /// Another input is open.
  void forget_region() { region_ = RegionControl(); }

  /// The camera of what is seen where the mouse points.
  [[nodiscard]] Camera seeing(const ControlledScene& on) const;
  /// The tensors under the mouse; none while something is dragged.
  [[nodiscard]] std::optional<TensorPick> tensor_under_mouse(const ControlledScene& on) const;
  /// Adds to a picture of `on` what the controls show: menu, marks, outlines of what can be taken hold of.
  void decorate(const ControlledScene& on, SceneView& picture);
  /// The pointer in the other eye's picture; none where both see it.
  [[nodiscard]] std::optional<Vec2> second_pointer() const { return pointer_.twin(); }

  [[nodiscard]] TouchControl& touch() noexcept { return touch_control_; }
  [[nodiscard]] const PaneControl& panes() const noexcept { return pane_control_; }
  [[nodiscard]] MenuControl& menu() noexcept { return menu_; }
  [[nodiscard]] RegionControl& region() noexcept { return region_; }
  [[nodiscard]] BrushControl& brush() noexcept { return brush_; }
  [[nodiscard]] TractPickControl& tract_pick() noexcept { return tract_pick_; }
  /// The view or a slice follows a drag.
  [[nodiscard]] bool moves_view() const noexcept { return view_.dragging() || slice_.dragging(); }
  /// Whether nothing is dragged that an edit would be of.
  [[nodiscard]] bool resting() const noexcept {
    return !region_.dragging() && !plane_image_.dragging() && !slice_.dragging() &&
           !pane_control_.dragging() && !brush_.painting() && !lens_.followed() && !color_lens_.followed() &&
           !hand_in_space_.holding();
  }
  /// Whether a lens or a cut was moved since the last call.
  [[nodiscard]] bool take_lens_moved() noexcept { return std::exchange(lens_moved_, false); }

 private:
  bool handle_pane(const InputEvent& event, const ControlledScene& on);
  bool handle_region(const InputEvent& event, const ControlledScene& on);
  bool handle_plane_image(const InputEvent& event, const ControlledScene& on);
  bool handle_lens(const InputEvent& event, const ControlledScene& on);
  std::string run_lens(Command command, const ControlledScene& on);
  std::string put_corner();
  [[nodiscard]] std::optional<Vec3> next_mark(const ControlledScene& on);

  ProbeSession& session_;
  Pointer pointer_;
  MenuControl menu_;
  HandInSpace hand_in_space_;
  ViewControl view_;
  SliceControl slice_;
  PaneControl pane_control_;
  LensControl lens_;
  ColorLensControl color_lens_;
  PlaneImageControl plane_image_;
  RegionControl region_;
  BrushControl brush_;
  TractPickControl tract_pick_;
  ViewHold view_hold_;
  TouchControl touch_control_;
  bool lens_moved_ = false;
};

}  // namespace palpate
