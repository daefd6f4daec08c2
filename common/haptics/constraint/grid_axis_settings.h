/// What can be edited of a haptic grid. Apart from grid_axis.h, which needs all settings.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "common/base/index.h"
#include "common/math/vec.h"

namespace palpate {

/// Which way the axes of a haptic grid run.
struct GridFrame {
  enum class Kind : std::uint8_t {
    kData,   ///< along the axes of the data's own grid, with a node on each of its points
    kWorld,  ///< along x, y and z of the data's coordinates
    kPlane,  ///< the third axis along `first`, the origin on the plane first.x = offset
    kAxes    ///< the first axis along `first`, the second towards `second`
  };
  Kind kind = Kind::kData;
  Vec3 first{0.0}, second{0.0};  ///< need not be unit
  double offset = 0.0;           ///< data units, for a unit normal times |first|

  bool operator==(const GridFrame&) const = default;
  /// Whether its directions span what they have to.
  [[nodiscard]] bool valid() const noexcept {
    if (kind == Kind::kData || kind == Kind::kWorld) return true;
    const double size = glm::length(first);
    if (!(size > 0.0) || !std::isfinite(size) || !std::isfinite(offset)) return false;
    constexpr double kLeastSine = 1e-6;
    return kind == Kind::kPlane ||
           glm::length(glm::cross(first, second)) > kLeastSine * size * glm::length(second);
  }
};

/// A landmark of a haptic grid: a plane that an axis is felt to cross. Data coordinates.
struct GridMark {
  int axis = 0;      ///< 0, 1, 2: across that axis of the grid, at `at`; 3: the plane normal.x = at
  Vec3 normal{0.0};  ///< of a plane; need not be unit
  double at = 0.0;   ///< along the axis, from the origin of the coordinates [data units]

  bool operator==(const GridMark&) const = default;
  [[nodiscard]] bool valid() const noexcept {
    if (!std::isfinite(at) || axis < 0 || axis > 3) return false;
    const double size = glm::length(normal);
    return axis < 3 || (size > 0.0 && std::isfinite(size));
  }
};

struct GridMarks {
  static constexpr int kMax = 16;
  std::array<GridMark, kMax> mark{};
  int count = 0;

  bool operator==(const GridMarks&) const = default;
  [[nodiscard]] bool valid() const noexcept {
    for (int i = 0; i < count; ++i) {
      if (!mark[as_size(i)].valid()) return false;
    }
    return count >= 0 && count <= kMax;
  }
};

/// Where another axis may take over.
enum class GridSwitch : std::uint8_t { kNodes, kMarks };
inline constexpr int kGridSwitchCount = 2;
[[nodiscard]] constexpr std::string_view name_of(GridSwitch where) noexcept {  ///< "marks"
  return where == GridSwitch::kNodes ? "nodes" : "marks";
}

struct GridAxisSettings {
  static constexpr int kMostPeaks = 8;

  double threshold = 0.006;  ///< pull across the axis by which another one takes over [m]
  double detents = 0.0;      ///< kappa of the nodes along the axis, in [0, 1]; 0: it is followed freely
  double notch = 0.003;      ///< reach of a landmark along the axis [m]; 0: landmarks are not felt
  GridSwitch switch_at = GridSwitch::kNodes;
  /// The rest takes effect when the chain is built.
  GridFrame frame;
  Vec3 spacing{0.0};  ///< of the nodes along the axes [data units]; 0: that of the data's points
  int peaks = 0;      ///< landmarks at that many peaks of the values along each axis
  GridMarks marks;    ///< further landmarks

  bool operator==(const GridAxisSettings&) const = default;

  [[nodiscard]] bool valid() const noexcept {
    return threshold > 0.0 && std::isfinite(threshold) && detents >= 0.0 && detents <= 1.0 && notch >= 0.0 &&
           std::isfinite(notch) && frame.valid() && is_finite(spacing) && spacing.x >= 0.0 &&
           spacing.y >= 0.0 && spacing.z >= 0.0 && peaks >= 0 && peaks <= kMostPeaks && marks.valid();
  }

  /// Whether a grid that was built for `other` has to be built anew.
  [[nodiscard]] bool rebuilds(const GridAxisSettings& other) const noexcept {
    return !(frame == other.frame) || spacing != other.spacing || peaks != other.peaks ||
           !(marks == other.marks);
  }

  /// See ChainSettings::each().
  template <typename Self, typename Visit>
  static void each(Self& self, Visit&& visit) {
    visit("grid_axis.threshold", self.threshold);
    visit("grid_axis.detents", self.detents);
    visit("grid_axis.notch", self.notch);
    visit("grid_axis.switch", self.switch_at);
    visit("grid_axis.frame", self.frame);
    visit("grid_axis.spacing", self.spacing);
    visit("grid_axis.peaks", self.peaks);
    visit("grid_axis.marks", self.marks);
  }
};

}  // namespace palpate
