/// Input reports of foot switches. Pure, allocates nothing.
///
///   kXKeys      0, 1, bits 1 left, 2 middle, 3 right of byte 2
///   kInfinity   2 bytes: bits 0 left, 1 middle, 2 right of the first
///   kKeyboard   8 bytes, a keyboard's: modifiers, 0, the usages of up to six keys. Pedals of this kind type
///               what they were set up for, as delivered a, b, c from the left
///
/// As buttons: 0 left, 1 middle, 2 right. A switch that a hand is guarded by counts as released in a report
/// that makes no sense.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

namespace palpate {

enum class PedalFormat : std::uint8_t { kXKeys, kInfinity, kKeyboard };

/// Bit i: pedal i is down. On a keyboard a key other than b and c is the first pedal. Nothing for a report of
/// another length, with bits or keys that no pedal has, or of a keyboard that cannot tell its keys apart.
[[nodiscard]] std::optional<std::uint32_t> pedals_of(PedalFormat format,
                                                     std::span<const std::uint8_t> report) noexcept;

}  // namespace palpate
