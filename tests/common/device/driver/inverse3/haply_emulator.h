/// Haply's service with an Inverse3 in a hand and a grip: what it sends and understands, whatever carries it.
///
/// It reads commands by itself, and only in the spelling of its version; a device that hears nothing for 100
/// ms idles.
#pragma once

#include <cstdint>
#include <string>

#include "tests/common/device/driver/arm_in_hand.h"

namespace palpate::test {

class HaplyEmulator {
 public:
  static constexpr double kIdleAfter = 0.100;       ///< [s]
  static constexpr Vec3 kMiddle{0.0, -0.12, 0.15};  ///< [m] in the maker's frame

  // What it is, and what goes wrong.
  std::string version = "3.5.2";
  std::string device = "049D";
  bool plugged = true;
  bool grip = true;
  bool calibrated = true, powered = true;
  bool tells_status = false;  ///< with each state, not in the snapshot alone
  bool old_buttons = false;   ///< button_0 to button_3
  unsigned buttons = 0;
  ArmInHand arm;

  // What became of it.
  std::uint64_t commands = 0;    ///< messages
  std::uint64_t understood = 0;  ///< forces
  std::string strange;           ///< the last message that was not understood; empty: none
  Vec3 last{0.0};                ///< [N] that was understood last, frame D
  ForceWitness wire;

  /// All that it has, as it is pushed to a new client.
  [[nodiscard]] std::string snapshot(double now);
  /// A message of a client; returns the one state that it is answered by.
  std::string take(double now, const std::string& message);
  /// Lives on.
  void advance(double now);
  /// The client is gone: the device idles.
  void left(double now);
  /// What HTTP brings at /3.0/version.
  [[nodiscard]] std::string version_page() const;

 private:
  [[nodiscard]] std::string state(bool all) const;
  double heard_ = -1.0;
};

}  // namespace palpate::test
