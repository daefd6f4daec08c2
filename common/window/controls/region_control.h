/// The region of interest of a volume: a box along the axes of its coordinates, to be cropped to. The mouse
/// takes hold of the dots in the middle of its faces, which go along their axis, and of the one in its own
/// middle; the probe puts its corners and takes hold of its faces. Plain arithmetic, no window.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "common/hand/technique/box_hold.h"
#include "common/render/camera.h"
#include "common/window/controls/view_control.h"
#include "common/window/input_event.h"

namespace palpate {

/// The middle of `bounds`, half as long along each axis.
[[nodiscard]] Box new_region(const Box& bounds);

class RegionControl {
 public:
  RegionControl() = default;
  explicit RegionControl(const std::optional<Box>& box) : box_(box) {}

  /// Data units; none to begin with.
  [[nodiscard]] const std::optional<Box>& box() const noexcept { return box_; }
  /// Another box, or none.
  void put(const std::optional<Box>& box);
  /// Presses take hold of the dot that is nearest to the mouse, within a few pixels; a face stays within
  /// `bounds` and on its side of the one across, the middle where the whole box is within them.
  /// @return whether the event was for the box.
  bool handle(const InputEvent& event, const PictureArea& area, const Camera& camera, const Box& bounds);
  /// The hand on the probe, as BoxHold.
  void follow_hand(bool pressed, const Vec3& hand, double reach, const Box& bounds);
  /// A first corner at `x`, then the one across from it; later, the corner nearest to `x` goes there.
  /// @return what to tell the user.
  std::string put_corner(const Vec3& x);
  [[nodiscard]] bool dragging() const noexcept { return held_.has_value() || hand_.held(); }
  void let_go() noexcept { held_.reset(); }
  /// The dots, or the first of two corners; none where there is no box.
  [[nodiscard]] std::vector<Vec3> dots() const;

 private:
  struct Hold {
    std::size_t handle = 0;   ///< a BoxFace, or kMiddle
    double x = 0.0, y = 0.0;  ///< where the mouse went down [pixels]
    Box from;                 ///< the box then
  };
  static constexpr std::size_t kMiddle = kBoxFaces;
  [[nodiscard]] static std::array<Vec3, kMiddle + 1> handles(const Box& box);
  void drag(const PictureArea& area, const Camera& camera, const Box& bounds);

  std::optional<Box> box_;
  std::optional<Vec3> corner_;  ///< the first of two
  double x_ = 0.0, y_ = 0.0;    ///< of the mouse [pixels]
  std::optional<Hold> held_;
  BoxHold hand_;
};

}  // namespace palpate
