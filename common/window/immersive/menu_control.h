/// The menu in space of a window: what it offers of the program, and what points at it: the mouse, along the
/// ray of the eye that sees it, or the stylus of a tracked hand.
#pragma once

#include <optional>
#include <vector>

#include "common/compose/window_model.h"
#include "common/render/scene_view.h"
#include "common/window/controls/view_control.h"
#include "common/window/immersive/space_menu.h"
#include "common/window/input_event.h"
#include "common/window/keys.h"

namespace palpate {

/// The ray of the eye through a place of its picture; parallel to the view in an orthographic one.
/// @param x, y from the upper left corner of the area [pixels].
[[nodiscard]] Ray ray_through(const Camera& camera, const PictureArea& area, double x, double y);
/// The same through a place in space.
[[nodiscard]] Ray ray_through(const Camera& camera, const Vec3& place);

class MenuControl {
 public:
  /// Shows it, or takes it away. @param modes names of the haptic modes.
  void toggle(const SceneState& scene, const SceneView& view, const std::vector<std::string>& modes);
  void hide() noexcept { menu_.reset(); }
  [[nodiscard]] bool shown() const noexcept { return menu_.has_value(); }

  /// It lies at the upper left of what the camera shows, a little before the screen; there where the hand
  /// comes, if that reaches no farther than `reach` from the focal point [data units]. Once a frame.
  void place(const Camera& camera, const PictureArea& area,
             const std::optional<double>& reach = std::nullopt);
  /// Height of an entry [data units]. @pre shown().
  [[nodiscard]] double entry() const { return menu_->drawn().unit; }
  /// Mouse over the picture. @return whether the event is the menu's.
  bool handle(const InputEvent& event, const PictureArea& area, const Camera& camera);
  /// The mouse holds a slider or knob, and nothing else sets it.
  [[nodiscard]] bool held_by_mouse() const noexcept { return menu_ && menu_->held() && button_; }
  /// SpaceMenu::held_way(), in data coordinates.
  [[nodiscard]] std::optional<Dial> held_way() const;
  /// Where the mouse points at the menu's plane, as the camera sees it; none where that is not before it.
  [[nodiscard]] std::optional<Vec3> mouse_place(const Camera& camera, const PictureArea& area) const;
  /// What the mouse holds is set by the hand that feels it, at `place`: moves of the mouse lead that hand
  /// alone.
  void follow_hand(const Camera& camera, const Vec3& place);
  /// A tracked stylus points along `ray`. @return whether it points at the menu: its button is that of the
  /// menu then.
  bool point(const Ray& ray, bool button);

  /// Carries out what was done since: sliders and knobs change `document` and `view`. @return commands that
  /// were chosen, oldest first.
  [[nodiscard]] std::vector<Command> act(const SceneState& scene, Document& document, SceneView& view);
  [[nodiscard]] std::optional<LabelView> drawn() const;

 private:
  void take(const SpaceEvent& event);

  std::optional<SpaceMenu> menu_;
  std::vector<SpaceEvent> events_;
  double x_ = -1.0, y_ = -1.0;  // of the mouse [pixels]
  bool button_ = false;         // of the mouse, on the menu
  bool by_hand_ = false;        // what it holds is set by follow_hand()
  double turned_ = 0.0;         // of the knob, when the view was turned last [degrees]
};

}  // namespace palpate
