/// A stand-in for OpenHaptics' HD library: a shared library with its functions, made by the tests, with a
/// scheduler, and an arm of its own in a hand.
///
/// Loaded by a program that knows nothing of it, its scheduler is a thread and its hand wanders; a test takes
/// hold of it by fake_hd_of(), stops that, and calls tick() itself.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "tests/common/device/driver/arm_in_hand.h"

namespace palpate::test {

struct FakeHd {
  bool by_itself = true;  ///< ticks in real time on a thread of its own
  ArmInHand arm;

  // What it is, and what goes wrong.
  bool plugged = true;
  bool busy = false;  ///< it is there and cannot be opened
  bool calibrated = true;
  bool updates_calibration = false;  ///< it becomes calibrated when it is asked to
  bool hung = false;                 ///< its scheduler stands still
  bool nonsense = false;
  int throwing_calls = 0;  ///< so many of the next positions that are asked for throw
  unsigned error = 0;      ///< of the next calls that are asked for it, until it is cleared
  int buttons = 0;
  /// By how much its encoders of the base, thigh and shin are off [rad]. With any, the library reports the
  /// position that its own model of the arm makes of what they say, as it does on a real one.
  std::array<double, 3> encoders_off{};
  double most = 3.3, lasting = 0.88;  ///< [N]

  // What became of it.
  int opened = 0, closed = 0;
  bool force_output = false, running = false, in_frame = false;
  bool out_of_frame = false;  ///< something was set or read outside of a frame
  std::uint64_t ticks = 0;
  Vec3 last{0.0};  ///< [N] that was set last
  ForceWitness wire;

  /// Lives on until `now`, and calls back.
  void (*tick)(double now) = nullptr;
};

/// The arm, with its own kinematics: the base turns about the vertical, thigh and shin in a vertical plane,
/// and the tip is kFakeRest before the base while it is in the middle (frame D: z to the user, y up).
inline constexpr double kFakeThigh = 0.21, kFakeShin = 0.17, kFakeRest = 0.24;  ///< [m]

FakeHd* fake_hd_of(const std::string& file);

}  // namespace palpate::test
