/// Transparent lines as layers: for each pixel the list of its fragments from front to back, each with its
/// depth, colour, opacity and the samples that it covers (an A-buffer; Carpenter 1984). So a pass that shows
/// something between them, such as rays through a volume (shaders/volume/layers.glsl), gives each its place,
/// whatever their number. Edges stay as smooth as samples make them.
///
/// Symbols. n fragments in the picture; 16 bytes each and 4 a pixel on the GPU. Ordering a pixel's m
/// fragments takes m steps where they come sorted, as those of a set of lines do (LineSet), m^2 / 2 at most.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "common/geometry/line.h"
#include "common/render/gl/object.h"
#include "common/render/line/line_pass.h"
#include "common/render/overlay/overlay.h"
#include "common/render/scene_view.h"

namespace palpate {

/// Needs the OpenGL context current in which it was made.
class LineLayers {
 public:
  /// Makes the lists of what `draw` draws by a LineProgram that goes into layers, as far as the depths of the
  /// framebuffer that is bound do not hide it; nothing is written there. `draw` may be called several times.
  /// @param width,height of that framebuffer, which the frame's uniform block holds, too.
  /// @return whether all fit what the driver lets a buffer take; else the lists are of no use.
  [[nodiscard]] bool collect(int width, int height, const std::function<void()>& draw);
  /// For shaders/line/layers.glsl.
  void bind() const;

 private:
  void reserve(std::size_t fragments);

  GlBuffer fragments_, heads_;
  std::size_t room_ = 0, pixels_ = 0;
  GlProgram sort_;
};

// The lines of a scene in its colours, also where a lens shows others, and what a legend says of them.

/// Needs the OpenGL context current in which it was made.
class ColoredLines {
 public:
  /// Takes other lines. @param lines null: none.
  void set_geometry(const std::vector<Line>* lines, const SceneFrame& frame);
  /// Takes the colours that `view` has for these lines. @return whether they look different now.
  bool update_colors(const SceneView& view);
  /// @param base how all lines of this picture are drawn. @param unit pixels a thousandth of its height.
  void draw(LineProgram& program, const SceneView& view, const SceneFrame& frame, const LineDraw& base,
            float unit);

  [[nodiscard]] ColorLegend& legend() noexcept { return legend_; }

 private:
  bool update_lens_colors(const SceneView& view);

  LineSet lines_;
  std::optional<LineStyle> shown_style_, shown_lens_style_;
  ColorLegend legend_;
};

}  // namespace palpate
