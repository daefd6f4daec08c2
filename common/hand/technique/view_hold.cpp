#include "common/hand/technique/view_hold.h"

namespace palpate {

std::optional<Vec3> ViewHold::follow(bool pressed, const Vec3& proxy) noexcept {
  if (pressed) {
    now_ = proxy;
    if (!from_) from_ = proxy;
    return std::nullopt;
  }
  if (!from_) return std::nullopt;
  const Vec3 left = moved();
  from_.reset();
  return left;
}

}  // namespace palpate
