/// Tracts as the GPU draws them (shaders/tract/): a strip of points for many lines. Pure arithmetic.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/render/camera.h"
#include "common/render/tract/tract_bundle.h"

namespace palpate {

/// One point, as laid out in the shader's buffer: half of what it takes as three numbers and three more.
struct TractPoint {
  Vec3f position{0.0F};       ///< scene frame
  std::uint32_t tangent = 0;  ///< packed_tangent(), or kBetweenLines

  static constexpr std::uint32_t kBetweenLines = 1U << 30U;
};

/// A unit vector, or zero, in three signed numbers of ten bits, of 511; x in the lowest ones. Each component
/// is off by 1/1022 at most, an eighth of what a screen shows of the colour made of it.
[[nodiscard]] std::uint32_t packed_tangent(const Vec3f& tangent) noexcept;

/// The lines of a piece, each without the points that a picture does not need, and a point between every two
/// of them: what is left lies within `tolerance` (scene frame) of the lines, with tangents of the whole ones.
/// Segments whose ends coincide, or are not finite, are left out. @pre piece < bundle.pieces.size().
[[nodiscard]] std::vector<TractPoint> piece_points(const TractBundle& bundle, std::size_t piece,
                                                   const SceneFrame& frame, double tolerance);

}  // namespace palpate
