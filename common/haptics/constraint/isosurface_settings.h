/// What can be edited of isosurfaces that are felt. Apart from isosurface.h, which needs all settings.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "common/base/index.h"

namespace palpate {

/// Which way an isosurface holds the probe.
enum class IsosurfaceHold : std::uint8_t {
  kWall,   ///< stops a probe that comes from either side, and lets it go back
  kBelow,  ///< stops only what comes from lower values
  kAbove,  ///< stops only what comes from higher values
  kLayer   ///< holds on to the probe from both sides
};
inline constexpr int kIsosurfaceHoldCount = 4;
[[nodiscard]] constexpr std::string_view name_of(IsosurfaceHold hold) noexcept {  ///< "wall"
  constexpr std::array<std::string_view, kIsosurfaceHoldCount> kNames{"wall", "below", "above", "layer"};
  return kNames[as_size(hold)];
}

/// A set of isovalues, data units.
struct Isovalues {
  static constexpr int kMax = 8;
  std::array<double, kMax> value{};
  int count = 0;

  bool operator==(const Isovalues&) const = default;
};

struct IsosurfaceSettings {
  Isovalues isovalues;  ///< none: those that the constraint was made with
  IsosurfaceHold hold = IsosurfaceHold::kWall;
  double depth = 0.010;        ///< stretch beyond which the surface lets the probe through [m]
  double snap_distance = 0.0;  ///< a layer holds a probe that comes this near [m], at most `depth`

  /// Where a streamline can be followed, too: that comes first in the chain, and its proxy meets the surface
  /// (Ikits 2006, figure 6.7). Takes effect when the chain is built.
  bool along_streamline = false;

  bool operator==(const IsosurfaceSettings&) const = default;

  [[nodiscard]] bool valid() const noexcept {
    if (isovalues.count < 0 || isovalues.count > Isovalues::kMax) return false;
    for (const double value : isovalues.value) {
      if (!std::isfinite(value)) return false;
    }
    return static_cast<int>(hold) < kIsosurfaceHoldCount && std::isfinite(depth) && depth > 0.0 &&
           snap_distance >= 0.0 && snap_distance <= depth;
  }

  /// See ChainSettings::each().
  template <typename Self, typename Visit>
  static void each(Self& self, Visit&& visit) {
    visit("isosurface.values", self.isovalues);
    visit("isosurface.hold", self.hold);
    visit("isosurface.depth", self.depth);
    visit("isosurface.snap", self.snap_distance);
    visit("isosurface.along_streamline", self.along_streamline);
  }
};

}  // namespace palpate
