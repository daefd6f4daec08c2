/// What can be edited of the cutting-plane widget (haptics/widget/plane_widget.h, which needs all settings).
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "common/base/index.h"
#include "common/math/vec.h"

namespace palpate {

/// Where a cutting plane lies and how it is turned.
struct PlanePose {
  Vec3 center{0.0};               ///< of its sphere, on the plane
  Vec4 turn{0.0, 0.0, 0.0, 1.0};  ///< unit quaternion x, y, z, w that turns z into the plane's normal

  bool operator==(const PlanePose&) const = default;
  [[nodiscard]] bool valid() const noexcept {
    constexpr double kUnit = 1e-6;
    return is_finite(center) && std::abs(glm::length(turn) - 1.0) < kUnit;
  }
};

struct PlanePoses {
  static constexpr int kMax = 4;
  std::array<PlanePose, kMax> pose{};
  int count = 0;

  bool operator==(const PlanePoses&) const = default;
  [[nodiscard]] bool valid() const noexcept {
    for (int i = 0; i < count; ++i) {
      if (!pose[as_size(i)].valid()) return false;
    }
    return count >= 0 && count <= kMax;
  }
};

struct PlaneWidgetSettings {
  double radius = 0.025;  ///< of the sphere about the centre [m]
  double reach = 0.008;   ///< stretch at which planes and sphere catch and let go [m]
  double detent = 15.0;   ///< step of felt angles [degrees], the data's axes with them; 0: none
  PlanePoses poses;       ///< data coordinates; none: one plane through the middle of the data
  int edit = 0;           ///< another number than before: the planes are put to `poses`

  bool operator==(const PlaneWidgetSettings&) const = default;

  [[nodiscard]] bool valid() const noexcept {
    constexpr double kHalfTurn = 180.0;
    return radius > 0.0 && std::isfinite(radius) && reach > 0.0 && std::isfinite(reach) && detent >= 0.0 &&
           detent <= kHalfTurn && poses.valid();
  }

  /// See ChainSettings::each().
  template <typename Self, typename Visit>
  static void each(Self& self, Visit&& visit) {
    visit("plane_widget.radius", self.radius);
    visit("plane_widget.reach", self.reach);
    visit("plane_widget.detent", self.detent);
    visit("plane_widget.poses", self.poses);
    visit("plane_widget.edit", self.edit);
  }
};

}  // namespace palpate
