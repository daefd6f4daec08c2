/// What a device has, taken apart: buttons, valuators and a position, all of one instant. What a hand does
/// with them is the interaction technique's affair (Ikits 2006, sec. 3.3).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "common/math/vec.h"

namespace palpate {

/// Plain data, exchanged whole between threads (base/triple_buffer.h).
struct DeviceAtoms {
  static constexpr std::size_t kValuators = 6;

  double time = 0.0;          ///< [s] of CLOCK_MONOTONIC, when it was taken
  std::uint32_t buttons = 0;  ///< bit i: button i is down
  bool has_position = false;
  bool has_valuators = false;
  Vec3 position{0.0};  ///< [m] frame D: x right, y up, z towards the user, from the middle of the workspace
  /// In [-1, 1], 0 at rest: push right, up, towards the user, then turn about these axes.
  std::array<double, kValuators> valuators{};

  bool operator==(const DeviceAtoms&) const = default;
};

}  // namespace palpate
