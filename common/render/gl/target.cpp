#include "common/render/gl/target.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string_view>

#include <epoxy/gl.h>

#include "common/base/check.h"
#include "common/base/error.h"
#include "common/base/index.h"
#include "common/render/gl/gpu_objects.h"

namespace palpate {
namespace {

// What every driver of OpenGL 4.5 offers at least, and software rasterisers at most.
constexpr int kSamples = 4;

GlRenderbuffer make_storage(GLenum format, int samples, int width, int height, std::string_view what) {
  GLuint name = 0;
  glCreateRenderbuffers(1, &name);
  GlRenderbuffer buffer(name);
  label_object(GpuObject::Kind::kRenderbuffer, name, what);
  if (samples > 1) {
    glNamedRenderbufferStorageMultisample(name, samples, format, width, height);
  } else {
    glNamedRenderbufferStorage(name, format, width, height);
  }
  return buffer;
}

GlFramebuffer make_framebuffer(const GlRenderbuffer& color, const GlRenderbuffer& depth) {
  GLuint name = 0;
  glCreateFramebuffers(1, &name);
  GlFramebuffer framebuffer(name);
  glNamedFramebufferRenderbuffer(name, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, color.name());
  if (depth) glNamedFramebufferRenderbuffer(name, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, depth.name());
  if (glCheckNamedFramebufferStatus(name, GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
    throw work_error("the OpenGL driver refuses a framebuffer with four samples a pixel");
  }
  return framebuffer;
}

}  // namespace

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

bool RenderTarget::resize(int width, int height, double resolution) {
  PALPATE_CHECK(resolution > 0.0 && resolution <= 1.0);
  const int scene_width = std::max(1, static_cast<int>(std::lround(resolution * width)));
  const int scene_height = std::max(1, static_cast<int>(std::lround(resolution * height)));
  if (width == width_ && height == height_ && scene_width == scene_width_ && scene_height == scene_height_)
    return false;
  GLint largest = 0;
  glGetIntegerv(GL_MAX_RENDERBUFFER_SIZE, &largest);
  if (width < 1 || height < 1 || width > largest || height > largest) {
    throw usage_error("a picture of " + std::to_string(width) + "x" + std::to_string(height) +
                      " pixels cannot be drawn; each side is 1 to " + std::to_string(largest));
  }
  scene_color_ = make_storage(GL_RGBA8, kSamples, scene_width, scene_height, "scene");
  scene_depth_ =
      make_storage(GL_DEPTH_COMPONENT32F, kSamples, scene_width, scene_height, "depths of the scene");
  averaged_color_ = make_storage(GL_RGBA8, 1, scene_width, scene_height, "scene, one sample a pixel");
  // The last picture of that size stays until the next is whole.
  if (width != width_ || height != height_) {
    resolved_color_ = make_storage(GL_RGBA8, 1, width, height, "picture");
    resolved_ = make_framebuffer(resolved_color_, {});
  }
  scene_ = make_framebuffer(scene_color_, scene_depth_);
  averaged_ = make_framebuffer(averaged_color_, {});
  width_ = width;
  height_ = height;
  scene_width_ = scene_width;
  scene_height_ = scene_height;
  still_ = {};
  growing_ = {};
  depth_copy_.reset();
  depth_framebuffer_.reset();
  return true;
}

void RenderTarget::bind_scene() {
  drawn_ = scene_.name();
  glBindFramebuffer(GL_FRAMEBUFFER, drawn_);
  glViewport(0, 0, scene_width_, scene_height_);
}

void RenderTarget::bind_layer(Layer& layer) {
  if (!layer.framebuffer) {
    layer.color = make_storage(GL_RGBA8, kSamples, scene_width_, scene_height_, "what stands still");
    layer.depth = make_storage(GL_DEPTH_COMPONENT32F, kSamples, scene_width_, scene_height_,
                               "depths of what stands still");
    layer.framebuffer = make_framebuffer(layer.color, layer.depth);
  }
  drawn_ = layer.framebuffer.name();
  glBindFramebuffer(GL_FRAMEBUFFER, drawn_);
  glViewport(0, 0, scene_width_, scene_height_);
}

void RenderTarget::bind_still() { bind_layer(still_); }
void RenderTarget::bind_growing() { bind_layer(growing_); }

void RenderTarget::copy(const GlRenderbuffer& from, const GlRenderbuffer& to) const {
  // Not a blit: software rasterisers take that sample by sample through a shader.
  glCopyImageSubData(from.name(), GL_RENDERBUFFER, 0, 0, 0, 0, to.name(), GL_RENDERBUFFER, 0, 0, 0, 0,
                     scene_width_, scene_height_, 1);
}

void RenderTarget::copy_still_to_scene() {
  copy(still_.color, scene_color_);
  copy(still_.depth, scene_depth_);
}

void RenderTarget::copy_growing_to_still() {
  copy(growing_.color, still_.color);
  copy(growing_.depth, still_.depth);
}

std::uint32_t RenderTarget::copy_depth() {
  if (!depth_copy_) {
    depth_copy_ = make_picture_texture(GL_DEPTH_COMPONENT32F, scene_width_, scene_height_, "depths for rays");
    depth_framebuffer_ = make_framebuffer();
    const GLuint name = depth_framebuffer_.name();
    glNamedFramebufferTexture(name, GL_DEPTH_ATTACHMENT, depth_copy_.name(), 0);
    glNamedFramebufferDrawBuffer(name, GL_NONE);
  }
  // Of the samples of a pixel the driver takes one.
  glBlitNamedFramebuffer(drawn_, depth_framebuffer_.name(), 0, 0, scene_width_, scene_height_, 0, 0,
                         scene_width_, scene_height_, GL_DEPTH_BUFFER_BIT, GL_NEAREST);
  return depth_copy_.name();
}

void RenderTarget::resolve() {
  const bool same_size = scene_width_ == width_ && scene_height_ == height_;
  // Samples can only be averaged between framebuffers of one size.
  glBlitNamedFramebuffer(scene_.name(), same_size ? resolved_.name() : averaged_.name(), 0, 0, scene_width_,
                         scene_height_, 0, 0, scene_width_, scene_height_, GL_COLOR_BUFFER_BIT, GL_NEAREST);
  if (same_size) return;
  glBlitNamedFramebuffer(averaged_.name(), resolved_.name(), 0, 0, scene_width_, scene_height_, 0, 0, width_,
                         height_, GL_COLOR_BUFFER_BIT, GL_LINEAR);
}

void RenderTarget::bind_resolved() {
  glBindFramebuffer(GL_FRAMEBUFFER, resolved_.name());
  glViewport(0, 0, width_, height_);
}

void RenderTarget::show(int left, int bottom, std::uint32_t framebuffer) const {
  glBlitNamedFramebuffer(resolved_.name(), framebuffer, 0, 0, width_, height_, left, bottom, left + width_,
                         bottom + height_, GL_COLOR_BUFFER_BIT, GL_NEAREST);
}

Image RenderTarget::read() const { return read_framebuffer(resolved_.name(), width_, height_); }

Image read_framebuffer(std::uint32_t framebuffer, int width, int height) {
  const auto row = 4 * as_size(width);
  Image image{width, height, std::vector<std::uint8_t>(row * as_size(height))};
  std::vector<std::uint8_t> upward(image.rgba.size());  // OpenGL counts rows from the bottom
  glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, upward.data());
  for (int y = 0; y < height; ++y) {
    std::memcpy(image.rgba.data() + row * as_size(y), upward.data() + row * as_size(height - 1 - y), row);
  }
  // The picture stands for itself: no part of it shows what lies behind it.
  for (std::size_t i = 3; i < image.rgba.size(); i += 4) image.rgba[i] = 255;
  return image;
}

}  // namespace palpate
