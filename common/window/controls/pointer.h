/// Where the mouse points in a picture for two eyes: with one half for each, a place is one of that half's
/// eye, whose picture it is drawn in.
#pragma once

#include <cstddef>
#include <optional>

#include "common/render/scene_view.h"
#include "common/window/controls/view_control.h"

namespace palpate {

/// The picture that a place of a window belongs to.
struct EyeArea {
  PictureArea area;                ///< of that picture
  std::optional<std::size_t> eye;  ///< 0 left, 1 right; none: there is one eye, or both see all of it
};

/// Of the place `x`, `y` in a window [pixels]; outside `picture`, of the nearest place in it.
[[nodiscard]] EyeArea eye_area(const StereoView& stereo, const PictureArea& picture, double x, double y);

/// The same place of the other half; none where there are no halves.
[[nodiscard]] std::optional<Vec2> in_other_half(const StereoView& stereo, const PictureArea& picture,
                                                double x, double y);

/// The mouse over such a picture.
class Pointer {
 public:
  /// The picture lies there now.
  void over(const StereoView& stereo, const PictureArea& picture);
  /// A press keeps it to the picture in which it was, until the button is let go.
  void follow(const InputEvent& event);
  /// The picture that it points at.
  [[nodiscard]] const PictureArea& area() const noexcept { return at_.area; }
  [[nodiscard]] const std::optional<std::size_t>& eye() const noexcept { return at_.eye; }
  /// Where the other eye is to see it; none where both see it already, or it is over no picture.
  [[nodiscard]] std::optional<Vec2> twin() const;

 private:
  StereoView stereo_;
  PictureArea picture_;
  EyeArea at_;
  double x_ = -1.0, y_ = -1.0;  // [pixels]
  int buttons_ = 0;             // that are down
};

/// The camera of a view is that of the eye that sees what is pointed at, for as long as this lives: its
/// rectangle stays, its eye is `seeing`'s.
class Aim {
 public:
  Aim(Camera& camera, const Camera& seeing);
  ~Aim();
  Aim(const Aim&) = delete;
  Aim& operator=(const Aim&) = delete;

 private:
  Camera& camera_;
  double field_of_view_;
  Vec2 eye_offset_;
};

/// The camera that draws what is seen there: the view's own, or that of the eye.
[[nodiscard]] Camera seeing_camera(const SceneView& view, const std::optional<std::size_t>& eye);

}  // namespace palpate
