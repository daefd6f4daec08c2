/// What the shaders of volumes are told of a volume, its fields, tables and bricks, as they get it
/// (shaders/volume/volume_block.glsl).
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>

#include "common/render/camera.h"
#include "common/render/frame_block.h"
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

/// Between which of the numbers of a field's image the tables of `view` spread their entries: those that
/// occur and at which some transfer function of that field changes.
struct NumberRange {
  double lower = 0.0;
  double upper = 1.0;  ///< > lower
};
[[nodiscard]] NumberRange table_range(const VolumeView& view, std::size_t field = 0);
/// The gradient magnitude at the last row of a field's region tables [value / data unit]: a little above all
/// regions, so that what is beyond it is clear. > 0.
[[nodiscard]] double highest_row(const VolumeView& view, std::size_t field);
/// The places between which the region tables of a field spread their entries.
[[nodiscard]] PlaceRange table_places(const VolumeView& view, std::size_t field);

/// What the number of a transfer function stands for.
struct TransferPlace {
  std::size_t field = 0;
  bool regions = false;   ///< by value and gradient magnitude
  int first_layer = 0;    ///< of its own tables: preintegrated, or of regions
  int first_brick_z = 0;  ///< of its map of empty bricks
};
/// Those of transfers_of(view). @param bricks an axis, of each field.
[[nodiscard]] std::vector<TransferPlace> transfer_places(const VolumeView& view,
                                                         const std::vector<Index3>& bricks);

/// Laid out as the struct Field of shaders/volume/volume_block.glsl.
struct FieldBlock {
  glm::mat4 grid_from_scene{1.0F};
  glm::vec4 lower{0.0F}, upper{0.0F}, points{1.0F}, bricks{1.0F}, slopes{1.0F};
};

/// Laid out as a std140 uniform block, bound to 1.
struct VolumeBlock {
  glm::vec4 lengths{0.0F};
  glm::ivec4 counts{0};  ///< lenses, planes that cut
  glm::vec4 far{0.0F};   ///< far_range()
  std::array<glm::ivec4, kMostTransfers> transfers{};
  std::array<FieldBlock, kMostFields> fields{};
};

/// @param bricks an axis, of each field up to the last one that is shown. @pre view.image is not null.
[[nodiscard]] VolumeBlock make_volume_block(const VolumeView& view, const SceneFrame& frame,
                                            const std::vector<Index3>& bricks);

/// Between which t on its rays a picture sees the volume of the context, and how far samples may be apart
/// there (shaders/volume/volume_block.glsl).
[[nodiscard]] glm::vec4 far_range(const VolumeView& view, const SceneFrame& frame, const FrameBlock& picture);

}  // namespace palpate
