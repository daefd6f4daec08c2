#include "common/render/volume/volume_cache.h"

#include <string>

#include <epoxy/gl.h>

#include "common/render/gl/target.h"

namespace palpate {

VolumeCache::VolumeCache(const VolumeView& view, const FrameBlock& block, std::uint32_t opaque_depth,
                         std::string_view what)
    : view_(view),
      block_(block),
      what_(what),
      width_(static_cast<int>(block.size.x)),
      height_(static_cast<int>(block.size.y)),
      framebuffer_(make_framebuffer()) {
  if (opaque_depth == 0) return;
  depth_ = make_picture_texture(GL_DEPTH_COMPONENT32F, width_, height_,
                                std::string("depths of the ").append(what));
  glCopyImageSubData(opaque_depth, GL_TEXTURE_2D, 0, 0, 0, 0, depth_.name(), GL_TEXTURE_2D, 0, 0, 0, 0,
                     width_, height_, 1);
}

bool VolumeCache::same(const VolumeView& view, const FrameBlock& block, bool opaque) const {
  return opaque == static_cast<bool>(depth_) && block == block_ && same_picture(view, view_);
}

GlTexture VolumeCache::make_picture() const {
  GlTexture picture = make_picture_texture(GL_RGBA16, width_, height_, what_);
  glClearTexImage(picture.name(), 0, GL_RGBA, GL_FLOAT, nullptr);
  return picture;
}

void VolumeCache::bind(const GlTexture& picture) const {
  glNamedFramebufferTexture(framebuffer_.name(), GL_COLOR_ATTACHMENT0, picture.name(), 0);
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer_.name());
  glViewport(0, 0, width_, height_);
}

std::uint64_t VolumeCache::bytes(std::uint64_t pictures) const noexcept {
  constexpr std::uint64_t kPictureBytes = 8, kDepthBytes = 4;  // a pixel
  return (kPictureBytes * pictures + (depth_ ? kDepthBytes : 0)) * static_cast<std::uint64_t>(width_) *
         static_cast<std::uint64_t>(height_);
}

}  // namespace palpate
