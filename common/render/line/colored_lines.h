/// The lines of a scene in its colours, also where a lens shows others, and what a legend says of them.
#pragma once

#include <optional>
#include <vector>

#include "common/geometry/line.h"
#include "common/render/line/line_pass.h"
#include "common/render/overlay/overlay.h"
#include "common/render/scene_view.h"

namespace palpate {

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
