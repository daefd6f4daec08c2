/// Numbers that look random, from a counter: the same whichever thread asks for them, and in any order.
#pragma once

#include <cstdint>

namespace palpate {

/// The `index`-th number of the generator SplitMix64 (Steele, Lea and Flood 2014) that starts at 0, as a
/// uniform number in [0, 1). @rt Safe.
[[nodiscard]] constexpr double uniform_at(std::uint64_t index) noexcept {
  std::uint64_t z = (index + 1) * 0x9e3779b97f4a7c15U;
  z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9U;
  z = (z ^ (z >> 27U)) * 0x94d049bb133111ebU;
  return static_cast<double>((z ^ (z >> 31U)) >> 11U) * 0x1p-53;
}

}  // namespace palpate
