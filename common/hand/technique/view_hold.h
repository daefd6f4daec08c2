/// A hand that takes hold of the scene and carries the view over a haptic grid (Ikits 2006, sec. 8.5: camera
/// control): along one axis of the grid at a time, and with detents by whole steps of it.
///
/// While the button is held the hand goes on as if the camera stood still; what is drawn is the view moved by
///
///   m = p_0 - p,   p_0 the proxy as the hand took hold, p the proxy now                            (1)
///
/// so that the place of the scene that was taken stays with the hand. As it lets go, the view stays there,
/// and the hand is where it is seen: at x + m.
#pragma once

#include <optional>

#include "common/math/vec.h"

namespace palpate {

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
