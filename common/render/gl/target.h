/// Where a picture is drawn: a multisampled framebuffer, and the plain one that it is resolved to.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "common/render/gl/object.h"
#include "common/render/scene_view.h"

namespace palpate {

/// What a framebuffer (0: the window's back buffer) holds from its lower left corner on, opaque.
[[nodiscard]] Image read_framebuffer(std::uint32_t framebuffer, int width, int height);

class RenderTarget {
 public:
  /// Makes framebuffers of this size (both > 0), unless they are there already. The multisampled one has
  /// `resolution` in (0, 1] as many pixels along either edge.
  /// @throws Error (usage) where the driver cannot draw that large.
  /// @return whether they were made anew, with nothing in them.
  bool resize(int width, int height, double resolution);

  void bind_scene();  ///< draw into the multisampled framebuffer, with depth
  /// Draw into a second framebuffer like the scene's, which nothing else changes. Made when first needed.
  void bind_still();
  void copy_still_to_scene();  ///< colours and depths, sample by sample
  /// Draw into a third one, for what is not to be shown until there is more of it. Made when first needed.
  void bind_growing();
  void copy_growing_to_still();  ///< likewise; bind_still() has been called since the size changed
  /// The depths, as they are now, of what bind_scene() or bind_still() bound last: one sample a pixel, for
  /// passes that look up what lies in front of them. @return the name of a texture that stays valid until the
  /// size changes.
  [[nodiscard]] std::uint32_t copy_depth();
  void resolve();        ///< copies it, averaged, to the plain one
  void bind_resolved();  ///< draw into the plain one, without depth
  [[nodiscard]] std::uint32_t resolved() const noexcept { return resolved_.name(); }  ///< the plain one
  [[nodiscard]] Image read() const;                                                   ///< of it
  /// Copies the plain one to the framebuffer that the window shows, `left` and `bottom` pixels from its
  /// lower left corner.
  void show(int left, int bottom, std::uint32_t framebuffer) const;

  [[nodiscard]] int scene_width() const noexcept { return scene_width_; }
  [[nodiscard]] int scene_height() const noexcept { return scene_height_; }

 private:
  int width_ = 0, height_ = 0;
  int scene_width_ = 0, scene_height_ = 0;
  std::uint32_t drawn_ = 0;  ///< the framebuffer that was bound last to be drawn into, with depth
  GlRenderbuffer scene_color_, scene_depth_, averaged_color_, resolved_color_;
  /// A framebuffer like the scene's.
  struct Layer {
    GlRenderbuffer color, depth;
    GlFramebuffer framebuffer;
  };
  void bind_layer(Layer& layer);
  void copy(const GlRenderbuffer& from, const GlRenderbuffer& to) const;

  Layer still_, growing_;
  GlFramebuffer scene_, resolved_;
  GlFramebuffer averaged_;  // between the two where their sizes differ
  GlTexture depth_copy_;
  GlFramebuffer depth_framebuffer_;
};

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
