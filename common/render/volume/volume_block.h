/// What the shaders of volumes are told, as they get it (shaders/volume/volume_block.glsl,
/// lens_segments.glsl).
#pragma once

#include <array>
#include <cstddef>

#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>

#include "common/render/camera.h"
#include "common/render/volume/volume_view.h"

namespace palpate {

/// The number that a texture of this type gives as 1: normalised integers reach it at their largest.
[[nodiscard]] double largest_number(ScalarType type) noexcept;

/// Where the corners of what is shown of `image` lie in the scene frame.
[[nodiscard]] std::array<Vec3, 8> corners_in_scene(const VolumeImage& image, const SceneFrame& frame);

/// How long samples of a view may be apart.
struct StepLengths {
  double longest = 1.0;  ///< that of the table [data units]
  int layers = 32;       ///< of a table; layer 0 has no length, the last one the longest
};

/// No ray of a view takes steps longer than this many of the shortest.
inline constexpr double kStepRatio = 16.0;

[[nodiscard]] StepLengths step_lengths(const VolumeView& view) noexcept;

/// Between which of the image's numbers the tables of `view` spread their entries: those that occur and at
/// which some transfer function changes.
struct NumberRange {
  double lower = 0.0;
  double upper = 1.0;  ///< > lower
};
[[nodiscard]] NumberRange table_range(const VolumeView& view) noexcept;

/// Laid out as a std140 uniform block, bound to 1.
struct VolumeBlock {
  glm::mat4 grid_from_scene{1.0F};
  glm::vec4 lower{0.0F}, upper{0.0F}, points{1.0F}, bricks{1.0F}, lengths{1.0F};
  std::array<glm::vec4, 1 + kMostLenses>
      parts{};  ///< transfer function, samples a voxel, shaded, 1 cut away or 2 coloured
  std::array<glm::vec4, kMostCuts> cuts{};  ///< outward unit normal, offset, N
  glm::ivec4 counts{0};                     ///< lenses, planes that cut
};

/// Laid out as a std140 uniform block, bound to 2.
struct LensBlock {
  std::array<glm::mat4, kMostLenses> unit_from_scene{};
  std::array<glm::vec4, kMostLenses> centers{};  ///< middle, magnification
  std::array<glm::ivec4, kMostLenses> faces{};
  std::array<glm::vec4, kMostLenses * kMostHalfSpaces> planes{};
  std::array<glm::vec4, kMostLenses> circles{};  ///< on the screen: middle, radius (0: none); transition
};

/// @param bricks an axis. @pre view.image is not null; at most kMostLenses lenses and kMostCuts planes.
[[nodiscard]] VolumeBlock make_volume_block(const VolumeView& view, const SceneFrame& frame,
                                            const Index3& bricks);
[[nodiscard]] LensBlock make_lens_block(const VolumeView& view, const SceneFrame& frame);

}  // namespace palpate
