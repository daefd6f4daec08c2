/// What mouse and keys do to a lens on a layer: it follows the mouse over the layer, the wheel changes its
/// size, a click or the key leaves it there. Plain arithmetic, no window.
#pragma once

#include <string>

#include "common/render/scene_view.h"
#include "common/scene/document/document.h"
#include "common/window/controls/view_control.h"
#include "common/window/input_event.h"
#include "common/window/keys.h"

namespace palpate {

/// A ball about the corner of the layer's triangles that is nearest to the viewer, a sixth of the longest side
/// of the scene in radius.
void place_lens(const SceneView& view, ColorLens& lens);

/// Adds such a lens to the document, where it shows what the settings name.
void add_color_lens(const SceneView& view, HeartOptions& heart);

class ColorLensControl {
 public:
  /// Moves view.color_lens. @return whether the event was for it.
  bool handle(const InputEvent& event, const PictureArea& area, SceneView& view);
  /// kLens, which has it follow the mouse or no longer, kLensSmaller and kLensLarger.
  /// @return what to tell the user.
  std::string run(Command command, SceneView& view);
  /// The lens follows the mouse from now on, or no longer.
  void follow(bool on) noexcept { followed_ = on; }
  [[nodiscard]] bool followed() const noexcept { return followed_; }

 private:
  double x_ = 0.0, y_ = 0.0;  ///< of the mouse [pixels]
  bool followed_ = false;
};

}  // namespace palpate
