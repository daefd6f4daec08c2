/// What an explorer takes from its input.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace palpate {

enum class FieldKind : std::uint8_t { kVector, kScalar, kTensor, kFibre };

inline constexpr std::array<FieldKind, 4> kFieldKinds{FieldKind::kVector, FieldKind::kScalar,
                                                      FieldKind::kTensor, FieldKind::kFibre};

/// "vector", "scalar", "tensor", "fibre".
[[nodiscard]] constexpr std::string_view name_of(FieldKind kind) noexcept {
  constexpr std::array<std::string_view, 4> kNames{"vector", "scalar", "tensor", "fibre"};
  return kNames[static_cast<std::size_t>(kind)];
}

}  // namespace palpate
