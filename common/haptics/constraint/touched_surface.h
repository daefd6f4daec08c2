/// What links that follow a surface in a chain are told of it.
#pragma once

#include "common/math/vec.h"

namespace palpate {

/// How a probe presses on a surface.
struct SurfaceContact {
  bool touches = false;
  double depth = 0.0;          ///< from the probe to its proxy [m]
  Vec3 normal{1.0, 0.0, 0.0};  ///< of the surface at the proxy, unit, either way
};

class TouchedSurface {
 public:
  TouchedSurface() = default;
  TouchedSurface(const TouchedSurface&) = delete;
  TouchedSurface& operator=(const TouchedSurface&) = delete;

  /// As of the last update.
  [[nodiscard]] virtual SurfaceContact contact() const noexcept = 0;

 protected:
  ~TouchedSurface() = default;
};

}  // namespace palpate
