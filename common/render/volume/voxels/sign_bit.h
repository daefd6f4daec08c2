/// Signed numbers of an image stand in memory as they are; as the image gives them, and as the GPU gets them, they are
/// unsigned ones in the same order: their sign bits are flipped.
#pragma once

#include <type_traits>

#include "common/render/volume/voxels/volume_image.h"

namespace palpate {

/// What numbers of an image of type T differ by from those in its `bytes`, bit by bit; 0 where they do not. @pre T is
/// the type that image.type says.
template <typename T>
requires std::is_unsigned_v<T>
[[nodiscard]] constexpr T sign_bit(const VolumeImage& image) noexcept {
  const bool is_signed =
      sizeof(T) == 1 ? image.stored == ScalarType::kInt8 : image.stored == ScalarType::kInt16;
  return is_signed ? static_cast<T>(T{1} << (8U * sizeof(T) - 1U)) : T{0};
}

}  // namespace palpate
