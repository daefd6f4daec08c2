#include "common/render/volume/estimate/sparse_rays.h"

#include <cstddef>

#include <epoxy/gl.h>

#include "common/base/index.h"
#include "common/render/gl/framebuffer.h"
#include "common/render/gl/object.h"
#include "common/render/volume/volume_bindings.h"

namespace palpate {

std::vector<std::uint8_t> pixels_of(const Image& image, const PixelLattice& lattice) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(4 * as_size(lattice.columns) * as_size(lattice.rows));
  for (int j = 0; j < lattice.rows; ++j) {
    for (int i = 0; i < lattice.columns; ++i) {
      for (const int component : image.pixel(lattice.place(i), image.height - 1 - lattice.place(j)))
        bytes.push_back(static_cast<std::uint8_t>(component));
    }
  }
  return bytes;
}

std::vector<std::uint8_t> cast_sparse_rays(VolumePass& pass, const VolumeView& as,
                                           const StillPicture& picture, const PixelLattice& lattice) {
  const FramebufferGuard before;
  const GlTexture pixels =
      make_picture_texture(GL_RGBA8, lattice.columns, lattice.rows, "pixels looked at again");
  std::vector<std::uint8_t> bytes = pixels_of(picture.behind, lattice);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTextureSubImage2D(pixels.name(), 0, 0, 0, lattice.columns, lattice.rows, GL_RGBA, GL_UNSIGNED_BYTE,
                      bytes.data());
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
  const GlFramebuffer framebuffer = make_framebuffer();
  glNamedFramebufferTexture(framebuffer.name(), GL_COLOR_ATTACHMENT0, pixels.name(), 0);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer.name());
  glViewport(0, 0, lattice.columns, lattice.rows);

  // The same view in pixels k times as large, the middle in the middle; their middles are those of the
  // picture's.
  const auto step = static_cast<float>(lattice.step);
  FrameBlock larger = picture.block;
  larger.size.x /= step;
  larger.size.y /= step;
  larger.size.z *= step;
  const GlBuffer block = volume_shader::make_block_buffer(larger);
  glBindBufferBase(GL_UNIFORM_BUFFER, volume_shader::kFrameBlock, block.name());
  pass.draw_as(as, picture.opaque_depth, static_cast<float>(lattice.step * picture.resolution));

  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, lattice.columns, lattice.rows, GL_RGBA, GL_UNSIGNED_BYTE, bytes.data());
  return bytes;
}

}  // namespace palpate
