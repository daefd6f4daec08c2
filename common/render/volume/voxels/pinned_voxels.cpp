#include "common/render/volume/voxels/pinned_voxels.h"

#include <utility>

#include <epoxy/gl.h>

#include "common/render/gl/context.h"
#include "common/render/volume/voxels/voxel_texture.h"

namespace palpate {
namespace {

bool is_signed(const VolumeImage& image) {
  return image.stored == ScalarType::kInt8 || image.stored == ScalarType::kInt16;
}

GLenum format_of(const VolumeImage& image) {
  if (image.type == ScalarType::kUint8) return is_signed(image) ? GL_R8I : GL_R8UI;
  if (image.type == ScalarType::kUint16) return is_signed(image) ? GL_R16I : GL_R16UI;
  return GL_R32F;
}

}  // namespace

std::shared_ptr<const PinnedVoxels> PinnedVoxels::pin(std::shared_ptr<const VolumeImage> image) {
  if (image->sparse || !is_software_rasteriser() || !epoxy_has_gl_extension("GL_AMD_pinned_memory"))
    return nullptr;
  GLint most = 0;
  glGetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &most);
  if (image->point_count() > static_cast<std::uint64_t>(most)) return nullptr;
  while (glGetError() != GL_NO_ERROR) {
  }
  GLuint name = 0;
  glGenBuffers(1, &name);
  GlBuffer buffer(name);
  glBindBuffer(GL_EXTERNAL_VIRTUAL_MEMORY_BUFFER_AMD, name);
  glBufferData(GL_EXTERNAL_VIRTUAL_MEMORY_BUFFER_AMD, static_cast<GLsizeiptr>(image->bytes.size()),
               image->bytes.data(), GL_STATIC_DRAW);
  glBindBuffer(GL_EXTERNAL_VIRTUAL_MEMORY_BUFFER_AMD, 0);
  if (glGetError() != GL_NO_ERROR) return nullptr;
  return std::shared_ptr<const PinnedVoxels>(new PinnedVoxels(std::move(image), std::move(buffer)));
}

PinnedVoxels::PinnedVoxels(std::shared_ptr<const VolumeImage> image, GlBuffer buffer)
    : image_(std::move(image)),
      buffer_(std::move(buffer)),
      texture_(make_texture(GL_TEXTURE_BUFFER, "voxels, read where they stand")) {
  glTextureBuffer(texture_.name(), format_of(*image_), buffer_.name());
}

PinnedVoxels::~PinnedVoxels() { glFinish(); }

void PinnedVoxels::bind(std::uint32_t unit) const { glBindTextureUnit(unit, texture_.name()); }

std::vector<std::string> PinnedVoxels::defines() const {
  if (image_->type == ScalarType::kFloat32)
    return {"PINNED samplerBuffer", "PINNED_LOWEST 0.0", "PINNED_UNIT 1.0"};
  const bool wide = image_->type == ScalarType::kUint16, sign = is_signed(*image_);
  return {sign ? "PINNED isamplerBuffer" : "PINNED usamplerBuffer",
          std::string("PINNED_LOWEST ") + (!sign  ? "0.0"
                                           : wide ? "-32768.0"
                                                  : "-128.0"),
          std::string("PINNED_UNIT ") + (wide ? "65535.0" : "255.0")};
}

}  // namespace palpate
