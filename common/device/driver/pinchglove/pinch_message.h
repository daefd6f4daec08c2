/// Messages of the Fakespace Pinch Glove: which fingers touch each other. Pure, allocates nothing.
///
///   0x80, pairs (left, right), 0x8F        0x81 … two bytes of time, 0x8F        0x82, text, 0x8F
///
/// A pair is a group of fingers in mutual contact, bits 0x10 thumb to 0x01 little finger of each hand; an
/// empty message: none touch. A message with anything else in it says nothing that could be relied on.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace palpate {

enum class PinchNews : std::uint8_t {
  kNothing,
  kContacts,  ///< contacts() are new
  kText,      ///< it answered
  kDamaged    ///< a message that cannot be: what touches now is not known
};

class PinchParser {
 public:
  [[nodiscard]] PinchNews push(std::uint8_t byte) noexcept;
  /// Bits 0 to 4: the right hand's fingers from the thumb on that touch another one; 5 to 9: the left hand's.
  [[nodiscard]] std::uint32_t contacts() const noexcept { return contacts_; }
  void clear() noexcept { state_ = State::kNone; }
  [[nodiscard]] std::uint64_t dropped() const noexcept { return dropped_; }  ///< bytes of no message

 private:
  enum class State : std::uint8_t { kNone, kContacts, kTimedContacts, kText };

  [[nodiscard]] PinchNews ended() noexcept;

  static constexpr std::size_t kMostGroups = 5, kMost = 2 * kMostGroups + 2;
  State state_ = State::kNone;
  std::array<std::uint8_t, kMost> bytes_{};
  std::size_t size_ = 0, text_ = 0;
  std::uint32_t contacts_ = 0;
  std::uint64_t dropped_ = 0;
};

}  // namespace palpate
