/// What mouse and keys do to the lenses of a volume. A key begins a lens under the mouse, or takes up the
/// last one; it follows the mouse in the plane through its middle that the camera faces, the wheel changes
/// its size, with Ctrl it moves it along the view, and a click or the key leaves it there. Plain arithmetic,
/// no window. A lens on the screen follows the mouse there, and is as far as the eye.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "common/render/camera.h"
#include "common/render/volume/volume_view.h"
#include "common/window/controls/view_control.h"
#include "common/window/input_event.h"
#include "common/window/keys.h"

namespace palpate {

/// A ball about `center` to begin with, a sixth of the longest side of `bounds` in radius, that shows what is
/// in it as `model` does.
[[nodiscard]] Lens new_lens(const Lens& model, const Vec3& center, const Box& bounds);

/// A circle in the middle of the screen, a quarter of its height in radius, that does likewise.
[[nodiscard]] Lens new_screen_lens(const Lens& model);
inline constexpr double kSmallestCircle = 0.01, kLargestCircle = 1.0;  ///< radius [heights of the picture]

/// The circle that a ball is seen as, across the view; nothing for other lenses.
[[nodiscard]] std::vector<Vec3> outline_of(const Lens& lens, const Camera& camera);

class LensControl {
 public:
  /// @param bounds of the scene, which limit sizes. @return whether the event was for a lens.
  bool handle(const InputEvent& event, const PictureArea& area, const Camera& camera, const Box& bounds,
              VolumeView& view);
  /// kLens, kLensSmaller and kLensLarger. @param model of a new lens. @return what to tell the user.
  std::string run(Command command, const PictureArea& area, const Camera& camera, const Box& bounds,
                  const Lens& model, VolumeView& view);
  /// From now on that lens follows the mouse. @return what to tell the user.
  std::string follow(std::size_t lens);
  /// The lens that follows the mouse.
  [[nodiscard]] std::optional<std::size_t> followed() const noexcept { return followed_; }
  void let_go() noexcept { followed_.reset(); }

 private:
  void follow_mouse(const PictureArea& area, const Camera& camera, Lens& lens) const;

  double x_ = 0.0, y_ = 0.0;  ///< of the mouse [pixels]
  bool control_ = false;      ///< the key is held
  std::optional<std::size_t> followed_;
};

}  // namespace palpate
