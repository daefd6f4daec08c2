/// Input reports of the 3Dconnexion SpaceMouse family, by their first byte and length: models differ in both.
///
///   1, 7 bytes: push        1, 13 bytes: push and turn        2, 7 bytes: turn        3, 2 to 7 bytes:
///   buttons
///
/// Numbers are signed 16-bit, little-endian; full deflection is about 350, on some models a little more.
/// Anything else (0x17 comes from wireless ones) says nothing of a hand. Pure, allocates nothing.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "common/device/atoms.h"

namespace palpate {

struct SpaceMouseState {
  std::array<std::int16_t, 6> raw{};  ///< push right, towards the user, down, then turns about these
  std::uint32_t buttons = 0;          ///< the first 32 bits of the bitmap, which is sparse on some models
};

enum class SpaceMouseNews : std::uint8_t { kNothing, kAxes, kButtons };

SpaceMouseNews take_report(std::span<const std::uint8_t> report, SpaceMouseState& state) noexcept;

inline constexpr double kSpaceMouseFull = 350.0;
inline constexpr int kSpaceMouseRest = 4;  ///< counts that a cap at rest may show

/// In the axes of the suite: x right, y up, z towards the user. @param signs +1 or -1 for each.
[[nodiscard]] std::array<double, DeviceAtoms::kValuators> valuators_of(
    const SpaceMouseState& state, const std::array<double, DeviceAtoms::kValuators>& signs) noexcept;

}  // namespace palpate
