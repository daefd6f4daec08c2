/// What the mouse does in panes of slices: a left drag moves the crosshair, with Shift it turns the other two planes
/// about it; a right drag sets the grey values, to the right a wider window, upward a higher level; a middle drag moves
/// the slices, the wheel goes through them, with Ctrl it enlarges them about the mouse. As in viewers of medical images.
/// Plain arithmetic, no window.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/render/scene_view.h"
#include "common/render/slice/slice_panes.h"
#include "common/window/controls/view_control.h"
#include "common/window/input_event.h"
#include "common/window/keys.h"

namespace palpate {

/// A picture of the scene, and the camera that it is seen by.
struct Sight {
  PictureArea area;
  Camera camera;
};

class PaneControl {
 public:
  /// Where the mouse goes and what it holds, whatever the event is for; a drag ends when its button does.
  /// @param volume null where there is none.
  void follow(const InputEvent& event, const PictureArea& picture, const VolumeView* volume);
  /// The pane in which the mouse is, or was when the button went down that is held; nothing where that has no slice.
  [[nodiscard]] std::optional<Sight> sight(const PictureArea& picture, const SceneView& scene) const;
  /// The place in its plane under the mouse, within the volume; nothing as above, or beside it.
  [[nodiscard]] std::optional<Vec3> place(const PictureArea& picture, const SceneView& scene) const;

  /// Presses and wheel count over panes only; a drag goes on outside until its button is let go.
  /// @param picture the whole of it. @pre follow() has had the event. @return whether it was for a pane.
  bool handle(const InputEvent& event, const PictureArea& picture, const SceneView& scene,
              VolumeView& volume);
  /// Arrows and page keys move the crosshair by one voxel along the normals of the planes.
  /// @return whether the command was one of these, and there are slices.
  static bool run(Command command, VolumeView& volume);
  [[nodiscard]] bool dragging() const noexcept { return drag_.has_value(); }
  void let_go() noexcept {
    drag_.reset();
    held_.reset();
    control_ = shift_ = false;
  }

  /// The pane under the mouse; nothing where that has no slice. @param parts of the picture.
  [[nodiscard]] const Pane* pane_under_mouse(const PictureArea& picture,
                                             const std::vector<Pane>& parts) const;
  /// The place under the mouse, its voxel and value, in words; empty where none is.
  [[nodiscard]] std::string words_under_mouse(const PictureArea& picture, const std::vector<Pane>& parts,
                                              const SceneView& scene) const;

 private:
  enum class Does : std::uint8_t { kCross, kTurn, kWindow, kMove };
  struct Drag {
    Does does = Does::kCross;
    MouseButton button = MouseButton::kLeft;
    SlicePlane plane = SlicePlane::kAxial;
  };
  void drag(const InputEvent& to, const PictureArea& picture, const SceneView& scene,
            VolumeView& volume) const;

  [[nodiscard]] std::optional<SlicePlane> plane_in_hand(const std::vector<Pane>& parts,
                                                        const PictureArea& picture) const;

  double x_ = -1.0, y_ = -1.0;                ///< of the mouse [pixels]
  double before_x_ = -1.0, before_y_ = -1.0;  ///< before the last event
  std::optional<MouseButton> held_;           ///< the first one that went down
  std::optional<SlicePlane> pressed_in_;      ///< where it did
  double turned_ = 0.0;                       ///< of the wheel, less than a notch
  bool control_ = false, shift_ = false;      ///< keys that are held
  std::optional<Drag> drag_;
};

}  // namespace palpate
