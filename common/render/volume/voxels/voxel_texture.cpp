#include "common/render/volume/voxels/voxel_texture.h"

#include <algorithm>
#include <cstdint>
#include <vector>

#include <epoxy/gl.h>

#include "common/render/gl/gpu_objects.h"
#include "common/render/volume/voxels/coarse_image.h"

namespace palpate {
namespace {

struct VoxelFormat {
  GLenum internal, type;
};

VoxelFormat format_of(ScalarType type) {
  switch (type) {
    case ScalarType::kUint8:
      return {GL_R8, GL_UNSIGNED_BYTE};
    case ScalarType::kUint16:
      return {GL_R16, GL_UNSIGNED_SHORT};
    default:
      return {GL_R32F, GL_FLOAT};
  }
}

}  // namespace

GlTexture make_texture(std::uint32_t target, std::string_view what) {
  GLuint name = 0;
  glCreateTextures(target, 1, &name);
  label_object(GpuObject::Kind::kTexture, name, what);
  return GlTexture(name);
}

void set_sampling(const GlTexture& texture, int filter, int border) {
  glTextureParameteri(texture.name(), GL_TEXTURE_MIN_FILTER, filter);
  glTextureParameteri(texture.name(), GL_TEXTURE_MAG_FILTER, filter);
  for (const GLenum wrap : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T, GL_TEXTURE_WRAP_R}) {
    glTextureParameteri(texture.name(), wrap, border);
  }
}

void set_voxel_sampling(const GlTexture& texture) {
  // One voxel beyond the border, as far as gradients reach, mirroring is the same as clamping. It keeps a
  // software rasteriser (llvmpipe) from interpolating 8-bit voxels in 8 bits, which is up to 6/255 off.
  set_sampling(texture, GL_LINEAR, GL_MIRROR_CLAMP_TO_EDGE);
}

GlTexture make_voxel_texture(const Index3& size, ScalarType type, std::string_view what) {
  GlTexture texture = make_texture(GL_TEXTURE_3D, what);
  glTextureStorage3D(texture.name(), 1, format_of(type).internal, size.x, size.y, size.z);
  set_voxel_sampling(texture);
  return texture;
}

void upload_voxels(const GlTexture& texture, const Index3& first, const Index3& size, ScalarType type,
                   const std::byte* bytes) {
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTextureSubImage3D(texture.name(), 0, first.x, first.y, first.z, size.x, size.y, size.z, GL_RED,
                      format_of(type).type, bytes);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
}

GlTexture upload_whole(const VolumeImage& image) {
  const Index3 n = image.points;
  GlTexture texture = make_voxel_texture(n, image.type, "voxels");
  const bool is_signed = image.stored == ScalarType::kInt8 || image.stored == ScalarType::kInt16;
  if (!image.sparse && !is_signed) {
    upload_voxels(texture, Index3(0), n, image.type, image.bytes.data());
    return texture;
  }
  // Some layers at a time, so that they are not all there at once.
  std::vector<std::byte> layers;
  for (int z = 0; z < n.z; z += kBlockSide) {
    const PointBox box{{0, 0, z}, {n.x, n.y, std::min(n.z, z + kBlockSide)}};
    layers.resize(box.count() * byte_size(image.type));
    image.copy(box, layers.data());
    upload_voxels(texture, box.first, box.end - box.first, image.type, layers.data());
  }
  return texture;
}

bool fits_whole(const VolumeImage& image, std::uint64_t memory) {
  constexpr std::uint64_t kMostOfSparse = std::uint64_t{64} << 20U;
  const Index3 n = image.points;
  const std::uint64_t bytes = image.byte_count();
  return std::max({n.x, n.y, n.z}) <= largest_volume_texture() && (memory == 0 || bytes <= memory) &&
         (!image.sparse || bytes <= kMostOfSparse);
}

std::shared_ptr<const VolumeImage> fitting_image(std::shared_ptr<const VolumeImage> image,
                                                 std::uint64_t memory) {
  while (!fits_whole(*image, memory)) {
    const Index3 points = image->points;
    image = coarse_image(*image, 1);
    if (image->points == points) break;
  }
  return image;
}

int largest_volume_texture() {
  GLint largest = 0;
  glGetIntegerv(GL_MAX_3D_TEXTURE_SIZE, &largest);
  return largest;
}

}  // namespace palpate
