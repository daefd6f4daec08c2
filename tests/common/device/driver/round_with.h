/// A link as its thread works it, with the force that a test asks for.
#pragma once

#include "common/device/driver_link.h"

namespace palpate::test {

/// A round of `link` while `force` is asked for, and it stays so until the next one.
inline bool round_with(DriverLink& link, const Vec3& force) {
  class Asking final : public ForceSource {
   public:
    Vec3 newest() noexcept override { return force; }
    Vec3 force{0.0};
  };
  static Asking asking;  // a library's own thread may ask between two rounds
  link.obey(nullptr);
  asking.force = force;
  link.obey(&asking);
  return link.round();
}

}  // namespace palpate::test
