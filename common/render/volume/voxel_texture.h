/// Textures in which voxels and what is known of them stand. All calls need a current context.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

#include "common/field/data_set.h"
#include "common/math/vec.h"
#include "common/render/gl/object.h"

namespace palpate {

/// A texture of `target` (GL_TEXTURE_3D...) without storage. @param what its label.
[[nodiscard]] GlTexture make_texture(std::uint32_t target, std::string_view what);
/// @param filter GL_NEAREST or GL_LINEAR, `border` how coordinates beyond [0, 1] are wrapped.
void set_sampling(const GlTexture& texture, int filter, int border);

/// Linear voxels of one number of `type`, as VolumeImage has them, without values yet.
[[nodiscard]] GlTexture make_voxel_texture(const Index3& size, ScalarType type, std::string_view what);
/// For a texture with voxels: linear, clamped to the border.
void set_voxel_sampling(const GlTexture& texture);
/// Gives the voxels from `first` on, `size` of them an axis, the numbers of `bytes`, x fastest.
void upload_voxels(const GlTexture& texture, const Index3& first, const Index3& size, ScalarType type,
                   const std::byte* bytes);
/// Voxels an axis of the largest texture of the driver.
[[nodiscard]] int largest_volume_texture();

}  // namespace palpate
