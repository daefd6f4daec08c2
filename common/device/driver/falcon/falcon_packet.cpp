#include "common/device/driver/falcon/falcon_packet.h"

#include <algorithm>
#include <cmath>

#include "common/base/index.h"

namespace palpate {
namespace {

constexpr std::uint8_t kStart = '<', kEnd = '>', kZero = 'A';
constexpr std::size_t kFlags = 13;
constexpr std::uint8_t kHoming = 0x01;
constexpr std::uint8_t kLights = kFalconGreen | kFalconBlue | kFalconRed;

/// Whether `byte` may stand at `place` of a reply. The last value but one is free: nobody knows its meaning.
bool fits(std::size_t place, std::uint8_t byte) noexcept {
  if (place < kFlags) return byte >= kZero && byte < kZero + 16;
  if (place == kFlags) return byte >= kZero && byte <= kZero + 0x7F;
  if (place == kFalconPacketBytes - 1) return byte == kEnd;
  return byte != kStart && byte != kEnd;
}

}  // namespace

FalconPacket encode(const FalconCommand& command) noexcept {
  FalconPacket packet{};
  packet.fill(kZero);
  packet.front() = kStart;
  packet.back() = kEnd;
  std::size_t place = 1;
  for (const std::int16_t motor : command.motors) {
    const auto bits = static_cast<std::uint16_t>(motor);
    for (unsigned shift = 0; shift < 16; shift += 4) {
      packet[place++] = static_cast<std::uint8_t>(kZero + ((bits >> shift) & 15U));
    }
  }
  packet[kFlags] =
      static_cast<std::uint8_t>(kZero + ((command.lights & kLights) | (command.homing ? kHoming : 0)));
  return packet;
}

std::optional<FalconReply> FalconReplyParser::push(std::uint8_t byte) noexcept {
  if (byte == kStart) {
    dropped_ += count_;
    packet_[0] = byte;
    count_ = 1;
    return std::nullopt;
  }
  if (count_ == 0 || !fits(count_, byte)) {
    dropped_ += count_ + 1;
    count_ = 0;
    return std::nullopt;
  }
  packet_[count_++] = byte;
  if (count_ < kFalconPacketBytes) return std::nullopt;
  count_ = 0;
  FalconReply reply;
  for (std::size_t i = 0; i < 3; ++i) {
    unsigned bits = 0;
    for (unsigned n = 0; n < 4; ++n) bits |= static_cast<unsigned>(packet_[1 + 4 * i + n] - kZero) << (4 * n);
    reply.encoders[i] = static_cast<std::int16_t>(static_cast<std::uint16_t>(bits));
  }
  const auto flags = static_cast<unsigned>(packet_[kFlags] - kZero);
  reply.buttons = flags & 15U;
  reply.homed = (flags >> 4U) & kFalconAllHomed;
  return reply;
}

FalconCounts motor_commands(const Vec3& torques, double counts_per_newton_metre, int most) noexcept {
  // The motors turn against the sense of the encoders.
  Vec3 counts = -counts_per_newton_metre * torques;
  if (!is_finite(counts)) return {};
  const double largest = std::max({std::abs(counts.x), std::abs(counts.y), std::abs(counts.z)});
  if (largest > most) counts *= most / largest;
  FalconCounts commands{};
  for (int i = 0; i < 3; ++i) {
    commands[as_size(i)] = static_cast<std::int16_t>(std::clamp<long>(std::lround(counts[i]), -most, most));
  }
  return commands;
}

FtdiRead strip_ftdi_status(std::span<std::uint8_t> transfer) noexcept {
  FtdiRead read;
  for (std::size_t at = 0; at < transfer.size(); at += kFtdiPacketBytes) {
    const auto packet = transfer.subspan(at, std::min(kFtdiPacketBytes, transfer.size() - at));
    if (packet.size() < kFtdiStatusBytes) break;
    read.modem = packet[0];
    read.has_status = true;
    const auto data = packet.subspan(kFtdiStatusBytes);
    std::copy(data.begin(), data.end(), transfer.begin() + static_cast<std::ptrdiff_t>(read.bytes));
    read.bytes += data.size();
  }
  return read;
}

}  // namespace palpate
