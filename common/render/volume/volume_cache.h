/// What the caches of a volume's pictures have in common: the view, pixels and depths z_0 of opaque things that
/// they were made for, and pictures as large as the frame with 16 bits a component.
#pragma once

#include <cstdint>
#include <string_view>

#include "common/render/frame_block.h"
#include "common/render/gl/object.h"
#include "common/render/volume/volume_view.h"

namespace palpate {

/// Needs the context current in which it was made.
class VolumeCache {
 public:
  /// z_0, for shaders/volume/ray.glsl; 0: there were no opaque things.
  [[nodiscard]] std::uint32_t depth() const noexcept { return depth_.name(); }

 protected:
  /// @param opaque_depth as of VolumePass::draw(); copied. @param what label of the pictures (gpu_objects.h).
  VolumeCache(const VolumeView& view, const FrameBlock& block, std::uint32_t opaque_depth,
              std::string_view what);
  ~VolumeCache() = default;

  /// Whether `view` looks in those pixels like the one that this was made for.
  /// @param opaque there are opaque things.
  [[nodiscard]] bool same(const VolumeView& view, const FrameBlock& block, bool opaque) const;
  /// An empty picture.
  [[nodiscard]] GlTexture make_picture() const;
  /// Draws into a picture from now on, all of it.
  void bind(const GlTexture& picture) const;
  [[nodiscard]] std::uint64_t bytes(std::uint64_t pictures) const noexcept;
  [[nodiscard]] const VolumeView& view() const noexcept { return view_; }
  [[nodiscard]] int width() const noexcept { return width_; }
  [[nodiscard]] int height() const noexcept { return height_; }

 private:
  VolumeView view_;
  FrameBlock block_;
  std::string_view what_;
  int width_ = 0, height_ = 0;
  GlTexture depth_;
  GlFramebuffer framebuffer_;
};

}  // namespace palpate
