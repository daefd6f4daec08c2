/// Textures in which voxels and what is known of them stand. All calls need a current context.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string_view>

#include "common/field/data_set.h"
#include "common/math/vec.h"
#include "common/render/gl/object.h"
#include "common/render/volume/voxels/volume_image.h"

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
/// All voxels of an image.
[[nodiscard]] GlTexture upload_whole(const VolumeImage& image);
/// Voxels an axis of the largest texture of the driver.
[[nodiscard]] int largest_volume_texture();
/// Whether an image is held as a whole: it fits a texture and `memory` [bytes]; 0: any. Sparse ones are not
/// made dense on the GPU, either, unless they are small: bricks leave parts out.
[[nodiscard]] bool fits_whole(const VolumeImage& image, std::uint64_t memory);
/// The image, or the finest coarser one (coarse_image.h) that is held as a whole.
[[nodiscard]] std::shared_ptr<const VolumeImage> fitting_image(std::shared_ptr<const VolumeImage> image,
                                                               std::uint64_t memory);

}  // namespace palpate
