/// A set of the values of an enumeration.
#pragma once

#include <cstdint>
#include <initializer_list>

namespace palpate {

/// @tparam Enum its values are at most 63 and not negative.
template <typename Enum>
class EnumSet {
 public:
  constexpr EnumSet() = default;
  constexpr EnumSet(std::initializer_list<Enum> values) noexcept {
    for (const Enum value : values) bits_ |= bit(value);
  }

  [[nodiscard]] constexpr bool has(Enum value) const noexcept { return (bits_ & bit(value)) != 0; }
  /// Whether some value is in both.
  [[nodiscard]] constexpr bool meets(EnumSet other) const noexcept { return (bits_ & other.bits_) != 0; }
  [[nodiscard]] constexpr bool empty() const noexcept { return bits_ == 0; }
  /// With `value` too, where `wanted`.
  [[nodiscard]] constexpr EnumSet with(Enum value, bool wanted = true) const noexcept {
    EnumSet set = *this;
    if (wanted) set.bits_ |= bit(value);
    return set;
  }

  constexpr bool operator==(const EnumSet&) const = default;

 private:
  static constexpr std::uint64_t bit(Enum value) noexcept {
    return std::uint64_t{1} << static_cast<unsigned>(value);
  }
  std::uint64_t bits_ = 0;
};

}  // namespace palpate
