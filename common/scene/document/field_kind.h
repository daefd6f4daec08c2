/// What an explorer takes from its input.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "common/base/index.h"

namespace palpate {

/// kNone: a program of devices, which has no input of fields.
enum class FieldKind : std::uint8_t { kVector, kScalar, kTensor, kFibre, kNone };

inline constexpr std::array<FieldKind, 5> kFieldKinds{
    FieldKind::kVector, FieldKind::kScalar, FieldKind::kTensor, FieldKind::kFibre, FieldKind::kNone};

/// "vector", "scalar", "tensor", "fibre", "none".
[[nodiscard]] constexpr std::string_view name_of(FieldKind kind) noexcept {
  constexpr std::array<std::string_view, 5> kNames{"vector", "scalar", "tensor", "fibre", "none"};
  return kNames[as_size(kind)];
}

}  // namespace palpate
