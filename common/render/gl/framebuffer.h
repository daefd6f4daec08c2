/// Pictures between passes: textures to draw into, and coming back to what was drawn to before.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "common/render/gl/object.h"

namespace palpate {

/// A texture of one level that is looked up texel by texel. @param format an internal format of OpenGL.
/// @param what its label (gpu_objects.h).
[[nodiscard]] GlTexture make_picture_texture(std::uint32_t format, int width, int height,
                                             std::string_view what);

[[nodiscard]] GlFramebuffer make_framebuffer();

/// Comes back, at its end, to the framebuffer and viewport that were drawn to at its beginning.
class FramebufferGuard {
 public:
  FramebufferGuard();
  ~FramebufferGuard();
  FramebufferGuard(const FramebufferGuard&) = delete;
  FramebufferGuard& operator=(const FramebufferGuard&) = delete;

 private:
  std::array<std::int32_t, 4> viewport_{};
  std::int32_t name_ = 0;
};

}  // namespace palpate
