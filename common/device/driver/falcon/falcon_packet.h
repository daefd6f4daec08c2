/// What goes over the wire to and from a Novint Falcon: packets of its firmware, and the framing of the FTDI
/// serial bridge that carries them. Nothing here allocates, throws or knows a bus.
///
/// A packet is 16 printable bytes: '<', 14 times a value + 'A', '>'. Values 1 to 12 are three signed 16-bit
/// numbers, four nibbles each, least significant first: motor commands one way, encoder counts the other.
/// Value 13 to the device holds lights and homing mode, from it buttons and which encoders are homed.
///
/// The bridge puts two bytes of modem and line status before the data of each packet of 64 bytes that the
/// host reads, and sends these two alone where it has no data.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "common/math/vec.h"

namespace palpate {

inline constexpr std::size_t kFalconPacketBytes = 16;
using FalconPacket = std::array<std::uint8_t, kFalconPacketBytes>;
using FalconCounts = std::array<std::int16_t, 3>;  ///< by arm: top, right, left, seen from the front

/// Lights of the grip, in value 13 to the device.
enum FalconLight : std::uint8_t { kFalconGreen = 0x02, kFalconBlue = 0x04, kFalconRed = 0x08 };
inline constexpr std::uint8_t kFalconAllHomed = 0x07;

struct FalconCommand {
  FalconCounts motors{};
  std::uint8_t lights = 0;  ///< sum of FalconLight
  bool homing = true;       ///< must stay set while the device is in use
};

struct FalconReply {
  FalconCounts encoders{};
  std::uint8_t buttons = 0;  ///< bits: plus, forward, centre, minus
  std::uint8_t homed = 0;    ///< bit i: encoder i has found its zero

  bool operator==(const FalconReply&) const = default;
};

[[nodiscard]] FalconPacket encode(const FalconCommand& command) noexcept;

/// Puts replies together from bytes however they were cut up or damaged. A start byte is never part of a
/// packet, so one that was damaged costs no other.
class FalconReplyParser {
 public:
  /// Takes a byte. @return the reply that it completes.
  std::optional<FalconReply> push(std::uint8_t byte) noexcept;
  /// Forgets what it has of a packet.
  void reset() noexcept { count_ = 0; }
  /// Bytes that were of no reply.
  [[nodiscard]] std::uint64_t dropped() const noexcept { return dropped_; }

 private:
  FalconPacket packet_{};
  std::size_t count_ = 0;
  std::uint64_t dropped_ = 0;
};

/// Motor commands in proportion to `torques`: all of them scaled where one would pass `most`, so that the
/// force keeps its direction. Zero for what is not finite.
inline constexpr int kFalconLargestCommand = 4095;
[[nodiscard]] FalconCounts motor_commands(const Vec3& torques, double counts_per_newton_metre,
                                          int most = kFalconLargestCommand) noexcept;

inline constexpr std::size_t kFtdiPacketBytes = 64;
inline constexpr std::size_t kFtdiStatusBytes = 2;
inline constexpr std::uint8_t kFtdiClearToSend = 0x10;  ///< in the first status byte

struct FtdiRead {
  std::size_t bytes = 0;    ///< of data, moved to the front
  std::uint8_t modem = 0;   ///< the newest first status byte
  bool has_status = false;  ///< there was one
};

/// Takes the status bytes out of what was read in one transfer.
FtdiRead strip_ftdi_status(std::span<std::uint8_t> transfer) noexcept;

}  // namespace palpate
