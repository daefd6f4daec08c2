// What devices send: the first byte chooses whose parser gets the rest, the second how it is cut into
// transfers. Whatever came before, a good packet after it is understood.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <variant>
#include <vector>

#include "common/device/driver/dataglove/dataglove_link.h"
#include "common/device/driver/falcon/falcon_packet.h"
#include "common/device/driver/pedal/pedal_link.h"
#include "common/device/driver/pinchglove/pinch_link.h"
#include "common/device/driver/polhemus/polhemus_record.h"
#include "common/device/driver/spacemouse/spacemouse_link.h"

using namespace palpate;

namespace {

void require(bool holds) {
  if (!holds) __builtin_trap();
}

void falcon(std::span<const std::uint8_t> bytes, std::size_t transfer) {
  FalconReplyParser parser;
  std::size_t replies = 0, passed = 0;
  for (std::size_t at = 0; at < bytes.size(); at += transfer) {
    const auto part = bytes.subspan(at, std::min(transfer, bytes.size() - at));
    std::vector<std::uint8_t> copy(part.begin(), part.end());
    const FtdiRead read = strip_ftdi_status(copy);
    require(read.bytes <= copy.size());
    passed += read.bytes;
    for (std::size_t i = 0; i < read.bytes; ++i) {
      const auto reply = parser.push(copy[i]);
      if (!reply) continue;
      ++replies;
      require(reply->buttons < 16 && reply->homed < 8);
    }
  }
  require(parser.dropped() + kFalconPacketBytes * replies <= passed);
  // A command without lights and homing has the form of an answer.
  const FalconCounts counts{-1234, 0, 32767};
  std::optional<FalconReply> last;
  for (const std::uint8_t byte : encode({.motors = counts, .homing = false})) last = parser.push(byte);
  require(last && last->encoders == counts);
}

void spacemouse(std::span<const std::uint8_t> bytes, std::size_t transfer) {
  SpaceMouseState state;
  for (std::size_t at = 0; at < bytes.size(); at += transfer) {
    (void)take_report(bytes.subspan(at, std::min(transfer, bytes.size() - at)), state);
    for (const double value : valuators_of(state, {1.0, 1.0, 1.0, 1.0, 1.0, 1.0})) {
      require(std::abs(value) <= 1.0);
    }
  }
}

void data_glove(std::span<const std::uint8_t> bytes, std::size_t transfer) {
  std::array<BendRange, kGloveNumbers> ranges;
  for (std::size_t at = 0; at < bytes.size(); at += transfer) {
    const auto numbers = glove_numbers(bytes.subspan(at, std::min(transfer, bytes.size() - at)));
    if (!numbers) continue;
    for (std::size_t i = 0; i < kGloveNumbers; ++i) {
      require((*numbers)[i] >= 0.0 && (*numbers)[i] <= 1.0);
      const double bend = ranges[i].bend((*numbers)[i]);
      require(bend >= 0.0 && bend <= 1.0);
    }
  }
}

/// Whatever came before, a whole message after it, and one that ends it, is understood.
void pinch_glove(std::span<const std::uint8_t> bytes) {
  PinchParser parser;
  std::size_t whole = 0;
  for (const std::uint8_t byte : bytes) {
    if (parser.push(byte) == PinchNews::kContacts) ++whole;
    require(parser.contacts() < 1U << 10U);
  }
  require(parser.dropped() + 2 * whole <= bytes.size());
  PinchNews last = PinchNews::kNothing;
  for (const std::uint8_t byte : {0x8F, 0x80, 0x00, 0x18, 0x8F})
    last = parser.push(static_cast<std::uint8_t>(byte));
  require(last == PinchNews::kContacts && parser.contacts() == 0b11U);
}

void pedal(std::span<const std::uint8_t> bytes, std::size_t transfer) {
  for (std::size_t at = 0; at < bytes.size(); at += transfer) {
    for (const PedalFormat format : {PedalFormat::kXKeys, PedalFormat::kInfinity, PedalFormat::kKeyboard}) {
      const auto pedals = pedals_of(format, bytes.subspan(at, std::min(transfer, bytes.size() - at)));
      require(!pedals || *pedals < 8U);
    }
  }
}

/// Whatever came before, of two whole records after it the second is understood.
template <class Parser>
void polhemus(std::span<const std::uint8_t> bytes, Parser parser, std::span<const std::uint8_t> whole) {
  for (const std::uint8_t byte : bytes) {
    const auto news = parser.push(byte);
    const auto* const record = news ? std::get_if<PolhemusRecord>(&*news) : nullptr;
    if (record == nullptr) continue;
    require(record->station >= 1 && record->station <= static_cast<int>(LibertyParser::kMostStations));
    require(is_finite(record->position) && std::abs(glm::length(record->orientation) - 1.0) < 1e-9);
  }
  std::optional<PolhemusNews> last;
  for (int n = 0; n < 2; ++n) {
    for (const std::uint8_t byte : whole) last = parser.push(byte);
  }
  require(last.has_value() && std::get<PolhemusRecord>(*last).position == Vec3(2.0, 2.0, 2.0));
}

// At (2, 2, 2), not turned.
constexpr std::uint8_t kLiberty[]{'L', 'Y',  1, 'C', ' ',  0,    28, 0, 0, 0, 0, 0x40, 0, 0, 0, 0x40, 0, 0,
                                  0,   0x40, 0, 0,   0x80, 0x3F, 0,  0, 0, 0, 0, 0,    0, 0, 0, 0,    0, 0};
constexpr std::uint8_t kFastrak[]{'0',  '1',  ' ', 0, 0, 0, 0x40, 0, 0, 0, 0x40, 0, 0, 0, 0x40, 0,   0,
                                  0x80, 0x3F, 0,   0, 0, 0, 0,    0, 0, 0, 0,    0, 0, 0, ' ',  '0', ' '};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 2) return 0;
  const std::span<const std::uint8_t> rest(data + 2, size - 2);
  const std::size_t transfer = 1 + data[1];
  switch (data[0] % 7) {
    case 0:
      falcon(rest, transfer);
      break;
    case 1:
      spacemouse(rest, transfer);
      break;
    case 2:
      polhemus(rest, LibertyParser(std::array{LibertyItem::kPosition, LibertyItem::kQuaternion}), kLiberty);
      break;
    case 3:
      polhemus(rest, FastrakParser(), kFastrak);
      break;
    case 4:
      data_glove(rest, transfer);
      break;
    case 5:
      pinch_glove(rest);
      break;
    default:
      pedal(rest, transfer);
  }
  return 0;
}
