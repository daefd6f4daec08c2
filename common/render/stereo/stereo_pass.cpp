#include "common/render/stereo/stereo_pass.h"

#include <algorithm>
#include <cstddef>
#include <string_view>

#include <epoxy/gl.h>

#include "common/base/check.h"
#include "common/base/error.h"
#include "common/render/gl/gpu_objects.h"
#include "common/render/gl/program.h"
#include "common/render/gl/target.h"

namespace palpate {
namespace {

constexpr GLint kModeLocation = 0, kFirstLocation = 1;

void make_layer(GlTexture& texture, GlFramebuffer& framebuffer, int width, int height,
                std::string_view what) {
  GLuint name = 0;
  glCreateTextures(GL_TEXTURE_2D, 1, &name);
  texture = GlTexture(name);
  label_object(GpuObject::Kind::kTexture, name, what);
  glTextureStorage2D(name, 1, GL_RGBA8, width, height);
  glTextureParameteri(name, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTextureParameteri(name, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  GLuint buffer = 0;
  glCreateFramebuffers(1, &buffer);
  framebuffer = GlFramebuffer(buffer);
  glNamedFramebufferTexture(buffer, GL_COLOR_ATTACHMENT0, name, 0);
  if (glCheckNamedFramebufferStatus(buffer, GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
    throw work_error("the OpenGL driver refuses a framebuffer for two eyes");
}

}  // namespace

std::vector<std::uint32_t> window_eye_buffers() {
  GLint two = 0;
  glGetNamedFramebufferParameteriv(0, GL_STEREO, &two);
  if (two == 0) return {GL_BACK};
  return {GL_BACK_LEFT, GL_BACK_RIGHT};
}

void show_eyes(const std::array<EyeSource, 2>& eyes, int width, int height, std::uint32_t framebuffer,
               std::span<const std::uint32_t> buffers, int left, int bottom) {
  for (std::size_t i = 0; i < std::min(eyes.size(), buffers.size()); ++i) {
    glNamedFramebufferDrawBuffer(framebuffer, buffers[i]);
    glBlitNamedFramebuffer(eyes[i].framebuffer, framebuffer, 0, eyes[i].bottom, width,
                           eyes[i].bottom + height, left, bottom, left + width, bottom + height,
                           GL_COLOR_BUFFER_BIT, GL_NEAREST);
  }
}

void StereoPass::begin(StereoMode mode, int width, int height) {
  PALPATE_CHECK(mode != StereoMode::kNone);
  if (mode == mode_ && width == width_ && height == height_) return;
  eye_size_ = eye_picture_size(mode, width, height);
  for (std::size_t i = 0; i < eyes_.size(); ++i)
    make_layer(eyes_[i], eye_framebuffers_[i], eye_size_.width, eye_size_.height,
               i == 0 ? "left eye" : "right eye");
  composed_height_ = mode == StereoMode::kQuadBuffer ? 2 * height : height;
  make_layer(picture_, framebuffer_, width, composed_height_, "both eyes");
  mode_ = mode;
  width_ = width;
  height_ = height;
}

void StereoPass::keep(std::size_t eye, std::uint32_t framebuffer) const {
  const auto [width, height] = eye_size_;
  glBlitNamedFramebuffer(framebuffer, eye_framebuffers_[eye].name(), 0, 0, width, height, 0, 0, width, height,
                         GL_COLOR_BUFFER_BIT, GL_NEAREST);
}

void StereoPass::compose(const std::array<int, 2>& first) {
  if (!program_) {
    program_ = compile_program("background/background.vert", "stereo/compose.frag");
    no_vertices_ = make_vertex_array();
  }
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
  glViewport(0, 0, width_, composed_height_);
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_BLEND);
  glUseProgram(program_.name());
  // In one picture, both buffers are shown one above the other.
  const StereoMode composed = mode_ == StereoMode::kQuadBuffer ? StereoMode::kTopBottom : mode_;
  glUniform1i(kModeLocation, static_cast<GLint>(composed));
  // Whether it is odd counts, of columns to the left of the display's first one, too.
  glUniform2i(kFirstLocation, first[0] & 1, first[1] & 1);
  for (std::size_t i = 0; i < eyes_.size(); ++i) glBindTextureUnit(static_cast<GLuint>(i), eyes_[i].name());
  glBindVertexArray(no_vertices_.name());
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glBindVertexArray(0);
  glUseProgram(0);
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
}

Image StereoPass::read() const { return read_framebuffer(framebuffer_.name(), width_, composed_height_); }

void StereoPass::show(int left, int bottom, std::uint32_t framebuffer) const {
  if (mode_ == StereoMode::kQuadBuffer && framebuffer == 0) {
    show_eyes({EyeSource{eye_framebuffers_[0].name()}, EyeSource{eye_framebuffers_[1].name()}}, width_,
              height_, framebuffer, window_eye_buffers(), left, bottom);
    // What is drawn over it is for both eyes.
    glNamedFramebufferDrawBuffer(framebuffer, GL_BACK);
    return;
  }
  glBlitNamedFramebuffer(framebuffer_.name(), framebuffer, 0, 0, width_, composed_height_, left, bottom,
                         left + width_, bottom + composed_height_, GL_COLOR_BUFFER_BIT, GL_NEAREST);
}

}  // namespace palpate
