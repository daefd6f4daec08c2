#include "common/render/gl/framebuffer.h"

#include <epoxy/gl.h>

#include "common/render/gl/gpu_objects.h"

namespace palpate {

GlTexture make_picture_texture(std::uint32_t format, int width, int height, std::string_view what) {
  GLuint name = 0;
  glCreateTextures(GL_TEXTURE_2D, 1, &name);
  GlTexture texture(name);
  label_object(GpuObject::Kind::kTexture, name, what);
  glTextureStorage2D(name, 1, format, width, height);
  glTextureParameteri(name, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTextureParameteri(name, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  return texture;
}

GlFramebuffer make_framebuffer() {
  GLuint name = 0;
  glCreateFramebuffers(1, &name);
  return GlFramebuffer(name);
}

FramebufferGuard::FramebufferGuard() {
  glGetIntegerv(GL_VIEWPORT, viewport_.data());
  glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &name_);
}

FramebufferGuard::~FramebufferGuard() {
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, static_cast<GLuint>(name_));
  glViewport(viewport_[0], viewport_[1], viewport_[2], viewport_[3]);
}

}  // namespace palpate
