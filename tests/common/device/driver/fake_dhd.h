/// A stand-in for Force Dimension's library: a shared library with its functions, made by the tests, with an
/// arm of its own in a hand. It keeps the maker's axes by its own code.
///
/// Loaded by a program that knows nothing of it, it lives on the clock of the system and its hand wanders; a
/// test takes hold of it by fake_dhd_of().
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "tests/common/device/driver/arm_in_hand.h"

namespace palpate::test {

struct FakeDhd {
  std::function<double()> now;  ///< [s]; null: the system's clock
  bool wanders = true;
  ArmInHand arm;

  // What it is, and what goes wrong.
  bool plugged = true;
  bool busy = false;  ///< it cannot be opened
  int type = 33;
  double max_force = 0.0;  ///< [N] that its maker's software allows; 0: not told
  bool powered = true, has_zero = true, broken = false;
  unsigned buttons = 0;
  bool closed_gripper = false;
  int failing_calls = 0;   ///< so many of the next ones return an error
  int repeated_calls = 0;  ///< so many return that they repeat themselves: no fault
  bool nonsense = false;   ///< positions are no numbers
  int throwing_calls = 0;  ///< so many of the next ones throw
  bool has_watchdog = true;
  bool deaf = false;  ///< a command is taken, and does nothing

  // What became of it.
  bool open = false, force_on = false;
  int force_off_cause = 0;
  int opened = 0, closed = 0;
  std::uint64_t commands = 0;
  Vec3 last{0.0};  ///< force of the last command, frame D
  ForceWitness wire;
  double last_time = 0.0;  ///< [s] of it
  int watchdog = 0;        ///< [1/8 ms] that was asked for
  bool gripper_is_button = false;

  void switch_force_off(int cause) {
    force_on = false;
    force_off_cause = cause;
    arm.push(Vec3{0.0});
  }
};

/// The fake inside of the library `file`, which is loaded. Null: it is another library.
FakeDhd* fake_dhd_of(const std::string& file);

}  // namespace palpate::test
