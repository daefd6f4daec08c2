/// Where the shaders of shaders/volume/ expect what they are told: bindings and locations, as they state
/// them.
#pragma once

#include <cstdint>
#include <span>

#include "common/render/gl/object.h"

namespace palpate::volume_shader {

// Blocks.
inline constexpr std::uint32_t kFrameBlock = 0, kVolumeBlock = 1, kShapeBlock = 2;
inline constexpr std::uint32_t kAxisLines = 5;  ///< a storage buffer

// Textures. Those of slabs and of the context are never in one program.
inline constexpr std::uint32_t kVoxels = 0, kTables = 1, kEmptyBricks = 2, kOpaqueDepth = 3, kTiles = 4,
                               kColors = 5;
inline constexpr std::uint32_t kCachedPicture = 6, kCachedDepth = 7, kStillDepth = 8;
inline constexpr std::uint32_t kContextFront = 6, kContextBack = 7, kContextKind = 8, kTileKinds = 9,
                               kCoarseVoxels = 10;
inline constexpr std::uint32_t kBrickIndex = 11;
inline constexpr std::uint32_t kFieldVoxels =
    12;  ///< of fields beside that of the context, and the next ones
inline constexpr std::uint32_t kRegionTables = 15;

// Uniforms.
inline constexpr std::int32_t kHasOpaqueDepth = 0;
inline constexpr std::int32_t kSlabNormal = 1, kSlabBorders = 2;
inline constexpr std::int32_t kContextPixel = 4, kWantedKind = 5, kFarthestLens = 6;
inline constexpr std::int32_t kHasCached = 40, kDepthPixel = 41;

/// A uniform block's buffer.
template <typename Block>
[[nodiscard]] GlBuffer make_block_buffer(const Block& block) {
  return make_buffer(std::span<const Block>(&block, 1));
}

}  // namespace palpate::volume_shader
