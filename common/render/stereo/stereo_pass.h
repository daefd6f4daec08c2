/// Puts the pictures of two eyes together: both are kept as textures, one triangle composes them.
///
/// Anaglyphs: with linear colours L and R, the picture is A L + B R, clamped. A and B are the least-squares
/// projection of Dubois 2009 ("Conversion of a stereo pair to anaglyph with the least-squares projection
/// method") for red-cyan glasses before an LCD; or, in grey, red takes the luminance (ITU-R BT.709) of L,
/// green and blue that of R.
///
/// For a window with two buffers nothing is composed: show() copies each picture into its own buffer.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "common/render/gl/object.h"
#include "common/render/scene_view.h"
#include "common/render/stereo/stereo_view.h"

namespace palpate {

/// The picture of an eye in a framebuffer.
struct EyeSource {
  std::uint32_t framebuffer = 0;
  int bottom = 0;  ///< its lowest row there
};

/// Where a window (framebuffer 0 of the current context) shows the eyes, left and right: each in a buffer of
/// its own, or where it has but one the left eye alone.
[[nodiscard]] std::vector<std::uint32_t> window_eye_buffers();

/// Copies `width` x `height` pixels of each eye into its buffer of `framebuffer`, at (left, bottom): eyes[0]
/// into the first one, and so on for as many as there are.
void show_eyes(const std::array<EyeSource, 2>& eyes, int width, int height, std::uint32_t framebuffer,
               std::span<const std::uint32_t> buffers, int left, int bottom);

class StereoPass {
 public:
  /// Makes what a picture of this size needs, unless it is there.
  /// @pre mode is not kNone. @throws Error (usage) as eye_picture_size().
  void begin(StereoMode mode, int width, int height);
  /// What each eye's picture has to have.
  [[nodiscard]] EyePictureSize eye_size() const noexcept { return eye_size_; }
  /// Keeps the picture that `framebuffer` holds as that of eye 0, left, or 1, right.
  void keep(std::size_t eye, std::uint32_t framebuffer) const;
  /// Both eyes are kept: draws the picture. @param first as StereoView.
  void compose(const std::array<int, 2>& first);
  /// @name The picture, as RenderTarget
  /// @{
  /// Of kQuadBuffer both pictures, the left eye's on top: twice as high as was asked for.
  [[nodiscard]] Image read() const;
  /// Of kQuadBuffer into the left and the right buffer of the window, framebuffer 0, or where that has but
  /// one the left eye's; into another framebuffer both, as read().
  void show(int left, int bottom, std::uint32_t framebuffer) const;
  /// @}

 private:
  StereoMode mode_ = StereoMode::kNone;
  int width_ = 0, height_ = 0;
  int composed_height_ = 0;
  EyePictureSize eye_size_;
  GlProgram program_;
  GlVertexArray no_vertices_;
  std::array<GlTexture, 2> eyes_;
  std::array<GlFramebuffer, 2> eye_framebuffers_;
  GlTexture picture_;
  GlFramebuffer framebuffer_;
};

}  // namespace palpate
