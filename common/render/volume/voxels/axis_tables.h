/// The axes of an image of uneven steps as shaders look them up (shaders/volume/lines.glsl).
///
/// An axis of n points has B equal buckets of [0, n - 1], as short as its shortest step where that makes not too many: the
/// cell in which each begins, B numbers, then m of its n points. Buckets begin as much too low as rounding may be.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "common/render/volume/voxels/volume_image.h"

namespace palpate {

/// What an image appends.
struct AxisTables {
  std::array<std::int32_t, 3> first{};    ///< where that of each axis begins
  std::array<std::int32_t, 3> buckets{};  ///< 0: even steps, no table
  std::int32_t size = 0;                  ///< of all [numbers]
};
[[nodiscard]] AxisTables axis_tables(const VolumeImage& image) noexcept;

/// @return the least n so that no bucket meets more than 2^n - 1 cells behind its first one.
int append_axis_tables(const VolumeImage& image, std::vector<float>& lines);

}  // namespace palpate
