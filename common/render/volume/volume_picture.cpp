#include "common/render/volume/volume_picture.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <utility>

#include <epoxy/gl.h>

#include "common/base/clock.h"
#include "common/base/index.h"
#include "common/render/color/palette.h"
#include "common/render/frame_block.h"
#include "common/render/gl/context.h"
#include "common/render/gl/object.h"
#include "common/render/scene_view.h"

namespace palpate {

struct VolumePicture::State {
  explicit State(Context which) {
    if (which == Context::kOwn) context.emplace();
    pass.emplace();
  }

  std::optional<OffscreenContext> context;
  std::optional<VolumePass> pass;  // needs a context
  int width = 0, height = 0;
  GlTexture color, depth;
  GlFramebuffer framebuffer;
  GlBuffer frame_buffer;
  FrameBlock block;
  bool has_depth = false;

  void update(const VolumeView& view, const Camera& camera) {
    const SceneFrame frame = frame_of(view);
    const ViewTransform transform =
        view_transform(camera, frame, view.image->bounds(), static_cast<double>(width) / height);
    block = make_frame_block(camera, transform, palette_of(Background::kDark), false, width, height);
    frame_buffer = make_buffer(std::span<const FrameBlock>(&block, 1));
    pass->update(view, frame, block);
  }

  void draw() {
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer.name());
    glViewport(0, 0, width, height);
    glClearColor(0.0F, 0.0F, 0.0F, 0.0F);
    glClear(GL_COLOR_BUFFER_BIT);
    glBindBufferBase(GL_UNIFORM_BUFFER, 0, frame_buffer.name());
    pass->draw(has_depth ? depth.name() : 0, block);
  }
};

VolumePicture::VolumePicture(int width, int height, Context context)
    : state_(std::make_unique<State>(context)) {
  State& s = *state_;
  s.width = width;
  s.height = height;
  GLuint name = 0;
  glCreateTextures(GL_TEXTURE_2D, 1, &name);
  s.color = GlTexture(name);
  glTextureStorage2D(name, 1, GL_RGBA32F, width, height);
  glCreateFramebuffers(1, &name);
  s.framebuffer = GlFramebuffer(name);
  glNamedFramebufferTexture(name, GL_COLOR_ATTACHMENT0, s.color.name(), 0);
}

VolumePicture::~VolumePicture() = default;

FloatImage VolumePicture::draw(const VolumeView& view, const Camera& camera,
                               const std::vector<float>& opaque_depth) {
  State& s = *state_;
  s.has_depth = !opaque_depth.empty();
  if (s.has_depth) {
    GLuint name = 0;
    glCreateTextures(GL_TEXTURE_2D, 1, &name);
    s.depth = GlTexture(name);
    glTextureStorage2D(name, 1, GL_DEPTH_COMPONENT32F, s.width, s.height);
    glTextureSubImage2D(name, 0, 0, 0, s.width, s.height, GL_DEPTH_COMPONENT, GL_FLOAT, opaque_depth.data());
    glTextureParameteri(name, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTextureParameteri(name, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  }
  s.update(view, camera);
  s.draw();
  FloatImage image{s.width, s.height, std::vector<float>(4 * as_size(s.width) * as_size(s.height))};
  glReadPixels(0, 0, s.width, s.height, GL_RGBA, GL_FLOAT, image.rgba.data());
  return image;
}

double VolumePicture::draw_alone(const VolumeView& view, const Camera& camera) {
  glFinish();
  const Stopwatch clock;
  state_->has_depth = false;
  state_->update(view, camera);
  state_->draw();
  glFinish();
  return 1e3 * clock.seconds();
}

double VolumePicture::draw_again() {
  glFinish();
  const Stopwatch clock;
  state_->draw();
  glFinish();
  return 1e3 * clock.seconds();
}

bool VolumePicture::prepare_slabs(std::size_t cut) {
  glBindFramebuffer(GL_FRAMEBUFFER, state_->framebuffer.name());
  glBindBufferBase(GL_UNIFORM_BUFFER, 0, state_->frame_buffer.name());
  const bool more = state_->pass->prepare_slabs(cut);
  glFinish();
  return more;
}

BrickShare VolumePicture::bricks() const { return state_->pass->bricks(); }

VolumePass::Cost VolumePicture::cost() const { return state_->pass->cost(); }

Rgba FloatImage::at(int x, int y) const {
  const float* p = rgba.data() + 4 * (as_size(y) * as_size(width) + as_size(x));
  return {p[0], p[1], p[2], p[3]};
}

SceneFrame frame_of(const VolumeView& view) { return scene_frame(view.image->bounds()); }

double worst_difference(const FloatImage& a, const FloatImage& b) {
  double worst = a.rgba.size() == b.rgba.size() ? 0.0 : HUGE_VAL;
  for (std::size_t i = 0; i < std::min(a.rgba.size(), b.rgba.size()); ++i) {
    const double off = std::abs(static_cast<double>(a.rgba[i]) - static_cast<double>(b.rgba[i]));
    if (!(off <= worst)) worst = off;  // NaN counts
  }
  return worst;
}

}  // namespace palpate
