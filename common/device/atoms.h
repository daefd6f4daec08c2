/// What a device has, taken apart: buttons, valuators, a position and poses. What a hand does with them is
/// the interaction technique's affair (Ikits 2006, sec. 3.3).
///
/// All are plain data, exchanged whole between threads (base/triple_buffer.h), so that neither side waits and
/// no half of one is ever seen.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "common/base/cache_line.h"
#include "common/math/quaternion.h"

namespace palpate {

/// Buttons, valuators and a position, all of one instant.
struct DeviceAtoms {
  static constexpr std::size_t kValuators = 6, kBends = 16, kJoints = 6;

  double time = 0.0;          ///< [s] of CLOCK_MONOTONIC, when it was taken
  std::uint32_t buttons = 0;  ///< bit i: button i is down
  bool has_position = false;
  bool has_valuators = false;
  std::uint8_t bend_count = 0;   ///< how many of `bends` a glove has
  std::uint8_t joint_count = 0;  ///< how many of `joints` an arm tells, all its life
  std::uint8_t station = 0;      ///< of a tracker: the one that `position` is of; 0: of none
  Vec3 position{0.0};  ///< [m] frame D: x right, y up, z towards the user, from the middle of the workspace
  /// In [-1, 1], 0 at rest: push right, up, towards the user, then turn about these axes.
  std::array<double, kValuators> valuators{};
  /// In [0, 1]: joints of a glove from the thumb on, 0 stretched, 1 bent as far as they were yet.
  std::array<double, kBends> bends{};
  /// Readings of an arm's joints from its base on, as its maker counts them [rad].
  std::array<double, kJoints> joints{};

  bool operator==(const DeviceAtoms&) const = default;
};

/// The pose of one sensor of a tracker. A line of the cache of its own.
struct alignas(kCacheLine) PoseAtom {
  double time = 0.0;                     ///< [s] of CLOCK_MONOTONIC, when it was taken
  Vec3 position{0.0};                    ///< [m] of the sensor in the tracker's frame, as reported: distorted
  Quat orientation{1.0, 0.0, 0.0, 0.0};  ///< unit; takes the sensor's axes to the tracker's
  std::uint32_t buttons = 0;             ///< bit i: button i of what carries the sensor is down
  std::uint8_t station = 0;              ///< from 1, as stations are numbered on a tracker's box
  bool valid = false;  ///< it is seen now; else the rest is what was known last, but buttons are up

  bool operator==(const PoseAtom&) const = default;
};

/// The poses of a tracker, each of its own instant: station i at index i - 1.
struct PoseAtoms {
  static constexpr std::size_t kStations = 16;

  std::array<PoseAtom, kStations> stations{};

  bool operator==(const PoseAtoms&) const = default;
};

}  // namespace palpate
