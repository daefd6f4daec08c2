#include "common/device/driver/pinchglove/pinch_message.h"

#include <bit>

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

}  // namespace palpate
