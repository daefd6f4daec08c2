#include "common/device/driver/pinchglove/pinch_link.h"

#include <algorithm>
#include <array>
#include <bit>
#include <span>
#include <string_view>
#include <utility>

#include "common/base/error.h"
#include "common/device/driver/transport/serial_line.h"

namespace palpate {
namespace {

constexpr std::uint8_t kPinchData = 0x80, kTimedData = 0x81, kText = 0x82, kPinchEnd = 0x8F, kMark = 0x80;
constexpr std::uint8_t kFingers = 0x1F;
constexpr std::size_t kLongestText = 64;  // [bytes]

/// Thumb first.
std::uint32_t from_thumb(std::uint8_t hand) noexcept {
  std::uint32_t fingers = 0;
  for (unsigned i = 0; i < 5; ++i) fingers |= ((static_cast<std::uint32_t>(hand) >> (4U - i)) & 1U) << i;
  return fingers;
}

constexpr double kPinchListen = 0.010;  // [s] that one round waits
constexpr double kPinchPause = 0.1;     // [s] between two tries to open the line
constexpr double kQueryTime = 0.1;      // [s] that the question may take to be sent
constexpr int kMostPinchMisses = 5;     // transfers in a row that may fail

// Messages without times; that it answers is also how it is known to be there.
constexpr std::array<std::uint8_t, 2> kQuery{'T', '0'};

}  // namespace

PinchNews PinchParser::push(std::uint8_t byte) noexcept {
  const bool inside = state_ == State::kContacts || state_ == State::kTimedContacts;
  if ((byte & kMark) != 0) {
    if (byte == kPinchEnd && state_ != State::kNone) return ended();
    // A message that begins within another one: the end of that was lost.
    state_ = byte == kPinchData   ? State::kContacts
             : byte == kTimedData ? State::kTimedContacts
             : byte == kText      ? State::kText
                                  : State::kNone;
    size_ = text_ = 0;
    if (state_ == State::kNone) ++dropped_;
    return inside || state_ == State::kNone ? PinchNews::kDamaged : PinchNews::kNothing;
  }
  if (state_ == State::kText && ++text_ <= kLongestText) return PinchNews::kNothing;
  if (inside && size_ < kMost) {
    bytes_[size_++] = byte;
    return PinchNews::kNothing;
  }
  ++dropped_;
  state_ = State::kNone;
  return PinchNews::kDamaged;
}

PinchNews PinchParser::ended() noexcept {
  const State state = state_;
  state_ = State::kNone;
  if (state == State::kText) return PinchNews::kText;
  std::size_t size = size_;
  if (state == State::kTimedContacts) {
    if (size < 2) return PinchNews::kDamaged;
    size -= 2;
  }
  if (size % 2 != 0 || size > 2 * kMostGroups) return PinchNews::kDamaged;
  std::uint32_t contacts = 0;
  for (std::size_t i = 0; i < size; i += 2) {
    const std::uint8_t left = bytes_[i], right = bytes_[i + 1];
    if (left > kFingers || right > kFingers) return PinchNews::kDamaged;
    const std::uint32_t group = from_thumb(right) | from_thumb(left) << 5U;
    // No finger touches itself, and none is in two groups, which would be one.
    if (std::popcount(group) < 2 || (group & contacts) != 0) return PinchNews::kDamaged;
    contacts |= group;
  }
  contacts_ = contacts;
  return PinchNews::kContacts;
}

PinchSettings pinch_settings(const DriverOptions& options) {
  PinchSettings settings;
  for (const auto& [name, value] : options) {
    if (name == "port") {
      settings.port = value;
    } else if (name == "baud") {
      settings.baud = baud_of("pinchglove", value);
    } else {
      throw usage_error("the driver pinchglove knows no option '" + name + "'; known are port, baud");
    }
  }
  if (settings.port.empty()) {
    throw usage_error("pinchglove: name its serial line, as in --device pinchglove:port=/dev/ttyUSB0");
  }
  return settings;
}

std::string pinch_help() {
  return "port=FILE  its serial line\n"
         "baud=N     of that line; default 9600\n";
}

std::string PinchLink::advice() const {
  if (status_.phase == LinkPhase::kReady) return {};
  if (stream_) {
    return "no Pinch Glove answers at " + line_->name() +
           "; check its power, the cable, and its switches for its rate (baud=)";
  }
  if (refused_ == TransferStatus::kGone) return "there is no serial line " + line_->name();
  if (refused_ == TransferStatus::kBusy) return "another program has " + line_->name() + "; end it";
  return line_->name() + " cannot be opened (" + std::string(name_of(refused_)) +
         (refused_ == TransferStatus::kDenied ? "); you must be in its group, mostly dialout" : ")");
}

bool PinchLink::round() noexcept {
  if (stream_) return listen();
  search();
  return false;
}

void PinchLink::search() noexcept {
  StreamOpened opened = line_->open();
  refused_ = opened.status;
  if (!opened.stream) {
    status_.phase = refused_ == TransferStatus::kGone ? LinkPhase::kAbsent : LinkPhase::kRefused;
    line_->sleep(kPinchPause);
    return;
  }
  stream_ = std::move(opened.stream);
  parser_.clear();
  misses_ = 0;
  ++status_.opened;
  status_.phase = LinkPhase::kLoading;
  heard_ = ask_at_ = line_->now();
}

bool PinchLink::listen() noexcept {
  std::array<std::uint8_t, 64> bytes{};
  double now = line_->now();
  TransferResult done;
  if (now >= ask_at_) {
    ask_at_ = now + kAskEvery;
    done = stream_->write(kQuery, kQueryTime);
  }
  if (done.ok() || done.status == TransferStatus::kTimeout) done = stream_->read(bytes, kPinchListen);
  now = line_->now();
  bool fresh = false;
  if (done.ok()) {
    misses_ = 0;
    const std::uint64_t before = parser_.dropped();
    for (const std::uint8_t byte : std::span(bytes).first(std::min(done.bytes, bytes.size()))) {
      switch (parser_.push(byte)) {
        case PinchNews::kNothing:
          continue;
        case PinchNews::kDamaged:
          ++status_.implausible;
          fresh = release() || fresh;
          continue;
        case PinchNews::kText:
          break;
        case PinchNews::kContacts:
          atoms_.buttons = parser_.contacts();
          break;
      }
      heard_ = now;
      ask_at_ = now + kAskEvery;
      ++status_.rounds;
      status_.phase = LinkPhase::kReady;
      atoms_.time = now;
      fresh = true;
    }
    status_.dropped += parser_.dropped() - before;
  } else if (given_up(done.status, kMostPinchMisses, misses_)) {
    return close();
  }
  if (now - heard_ <= kSilence) return fresh;
  if (status_.phase == LinkPhase::kReady) ++status_.faults;
  status_.phase = LinkPhase::kRefused;
  return release() || fresh;
}

bool PinchLink::release() noexcept {
  atoms_.time = line_->now();
  return std::exchange(atoms_.buttons, 0U) != 0;
}

bool PinchLink::close() noexcept {
  ++status_.faults;
  stream_.reset();
  refused_ = TransferStatus::kGone;
  status_.phase = LinkPhase::kAbsent;
  (void)release();
  return true;
}

}  // namespace palpate
