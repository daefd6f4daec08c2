/// What the shaders of volumes are told of a volume, its fields, tables and bricks, as they get it
/// (shaders/volume/volume_block.glsl).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/mat4x4.hpp>

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

/// What the number of a transfer function stands for; laid out as the struct Transfer of
/// shaders/volume/volume_block.glsl.
struct TransferBlock {
  std::int32_t field = 0;
  std::int32_t by_regions = 0;   ///< 1: by value and gradient magnitude
  std::int32_t first_layer = 0;  ///< of its own tables: preintegrated, or of regions
  std::int32_t first_brick = 0;  ///< z of its map of empty bricks
};
/// Those of transfers_of(view). @param bricks an axis, of each field.
[[nodiscard]] std::vector<TransferBlock> transfer_blocks(const VolumeView& view,
                                                         const std::vector<Index3>& bricks);

/// Laid out as the struct Field of shaders/volume/volume_block.glsl.
struct FieldBlock {
  glm::mat4 grid_from_scene{1.0F};
  Vec3f lower{0.0F};  ///< corner of the volume, g
  float first_number = 0.0F;
  Vec3f upper{0.0F};
  float entries_a_number = 0.0F;
  Vec3f points{1.0F};
  float first_entry = 0.0F;
  Vec3f bricks{1.0F};
  float samples_to_leap = 0.0F;  ///< a voxel
  float rows_a_slope = 0.0F;
  float first_row = 0.0F;
  float reference_lengths = 0.0F;  ///< a unit of N
  float unused = 0.0F;
  std::array<std::int32_t, 4>
      lines{};  ///< where the table of each axis begins (axis_tables.h); -1: even steps
  std::array<std::int32_t, 4> buckets{};  ///< of these tables
};

/// Between which t on its rays a picture sees the volume of the context, and how far samples may be apart
/// there.
struct FarRange {
  float first = 0.0F;
  float rate = 0.0F;       ///< 1 / depth of the volume in t
  float doublings = 0.0F;  ///< log2 of how many times as long steps are at its far end
};

/// Laid out as the std140 uniform block of shaders/volume/volume_block.glsl, bound to 1.
struct VolumeBlock {
  float layer_length = 0.0F;  ///< of layer 1 of a table, N
  float layer_count = 0.0F;
  float opaque = 0.0F;      ///< opacity at which rays end
  float asks_tiles = 0.0F;  ///< 1 or 0
  std::int32_t lens_count = 0;
  std::int32_t cut_count = 0;
  FarRange far;
  float context_fade = 0.0F;  ///< VolumeView::context_fade
  std::array<float, 2> unused{};
  std::array<TransferBlock, kMostTransfers> transfers{};
  std::array<FieldBlock, kMostFields> fields{};
};

/// @param bricks an axis, of each field up to the last one that is shown. @pre view.image is not null.
[[nodiscard]] VolumeBlock make_volume_block(const VolumeView& view, const SceneFrame& frame,
                                            const std::vector<Index3>& bricks);

[[nodiscard]] FarRange far_range(const VolumeView& view, const SceneFrame& frame, const FrameBlock& picture);

}  // namespace palpate
