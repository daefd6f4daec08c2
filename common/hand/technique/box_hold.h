/// A hand that takes hold of the faces of a box, one at a time, and so sizes a region of interest along a
/// haptic grid (Ikits 2006, sec. 8.5): the face goes along its axis to where the hand is led.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "common/math/vec.h"

namespace palpate {

/// A face of a box: 2 axis + side, side 0 being the lower one.
using BoxFace = std::size_t;
inline constexpr BoxFace kBoxFaces = 6;

/// The corners as the option --box has them: x,y,z,x,y,z.
[[nodiscard]] std::string box_text(const Box& box);

/// Moves a face of `box` to `to` [data units]. It stays within `bounds`, or where it is if that is beyond
/// them, and a thousandth of the bounds' side away from the face across. Nothing else changes, to the bit.
void move_face(BoxFace face, double to, const Box& bounds, Box& box) noexcept;

class BoxHold {
 public:
  /// Once a step or frame. A press takes hold of the face that is nearest to `hand`, if its rectangle lies
  /// within `reach` [data units]; the face then follows until the button is let go.
  void follow(bool pressed, const Vec3& hand, double reach, const Box& bounds, Box& box) noexcept;
  [[nodiscard]] const std::optional<BoxFace>& held() const noexcept { return held_; }

 private:
  bool pressed_ = false;
  std::optional<BoxFace> held_;
};

// A hand that takes hold of the scene and carries the view over a haptic grid (Ikits 2006, sec. 8.5: camera
// control): along one axis of the grid at a time, and with detents by whole steps of it.
//
// While the button is held the hand goes on as if the camera stood still; what is drawn is the view moved by
//
//   m = p_0 - p,   p_0 the proxy as the hand took hold, p the proxy now                            (1)
//
// so that the place of the scene that was taken stays with the hand. As it lets go, the view stays there,
// and the hand is where it is seen: at x + m.

class ViewHold {
 public:
  /// Once a step or frame. @param proxy data units.
  /// @return m of (1) as the button is let go; none at all other times.
  std::optional<Vec3> follow(bool pressed, const Vec3& proxy) noexcept;
  /// m of (1); 0 while nothing is held.
  [[nodiscard]] Vec3 moved() const noexcept { return from_ ? *from_ - now_ : Vec3{0.0}; }

 private:
  std::optional<Vec3> from_;  ///< p_0
  Vec3 now_{0.0};             ///< p
};

}  // namespace palpate
