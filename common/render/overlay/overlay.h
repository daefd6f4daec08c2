/// What lies flat over the picture: title, colour bars or legend, axes, newtons at the band, numbers of kept
/// lines. Drawn with Dear ImGui's draw list
/// in a context of its own, so that the window and a picture without a display get the same pixels.
#pragma once

#include <array>
#include <cstddef>
#include <memory>

#include "common/render/scene_view.h"

namespace palpate {

/// What the colour bar says about the lines that are shown.
struct ColorLegend {
  ValueRange range;
  ValueRange lens_range;      ///< of what SceneView::color_lens shows
  bool values_below = false;  ///< some lie below the range
  bool values_above = false;
  std::array<std::size_t, kEndCount> ends{};  ///< lines by end reason
  bool has_lines = false;     ///< coloured ones, the followed one among them, or surfaces are shown
  bool forces_above = false;  ///< some along the path lie above its range
};

/// Needs the OpenGL context current in which it was made.
class Overlay {
 public:
  Overlay();
  ~Overlay();
  Overlay(const Overlay&) = delete;
  Overlay& operator=(const Overlay&) = delete;

  /// Draws onto the framebuffer that is bound.
  void draw(const SceneView& view, const ColorLegend& legend, int width, int height);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Height of the overlay's text for a picture of this size [pixels].
[[nodiscard]] float overlay_text_height(int width, int height) noexcept;

}  // namespace palpate
