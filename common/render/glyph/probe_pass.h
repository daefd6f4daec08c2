/// Draws a ProbeView: its lines with the line program, its path with an append buffer, and its glyphs.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "common/render/camera.h"
#include "common/render/gl/object.h"
#include "common/render/glyph/glyph_pass.h"
#include "common/render/glyph/probe_glyphs.h"
#include "common/render/line/line_pass.h"
#include "common/render/line_style.h"
#include "common/render/probe_view.h"
#include "common/render/scene_view.h"
#include "common/render/tensor/tensor_glyph_mesh.h"

namespace palpate {

// The path of the proxy on the GPU: an append buffer. What is there already is not uploaded again while
// the path grows, and may be drawn part by part.

class LineTrail {
 public:
  /// Uploads what the first `count` points of `path` have beyond those that are there; all of them where
  /// the path, frame or range is another one, or there are fewer.
  /// @return whether everything was uploaded anew.
  bool extend(const std::shared_ptr<const ProbePath>& path, std::size_t count, const SceneFrame& frame,
              const ValueRange& range);

  [[nodiscard]] std::size_t size() const noexcept { return size_; }
  /// The first so many points stay as they are however the path grows: the direction of the last one
  /// depends on the next.
  [[nodiscard]] std::size_t settled() const noexcept { return size_ == 0 ? 0 : size_ - 1; }

  /// Whether some force lies above the range.
  [[nodiscard]] bool above_range() const noexcept { return above_range_; }

  /// Draws the path between the points `first` and `last` (included; both < size()).
  /// @pre LineProgram::use().
  void draw(const LineDraw& how, std::size_t first, std::size_t last) const;

 private:
  void reserve(std::size_t count);

  std::shared_ptr<const ProbePath> path_;
  SceneFrame frame_;
  ValueRange range_;
  std::size_t size_ = 0, capacity_ = 0;
  bool above_range_ = false;
  GlVertexArray vertex_array_;
  GlBuffer points_, values_;
};

/// Needs the context current in which it was made, and the frame's uniform block bound to 0.
class ProbePass {
 public:
  /// Uploads what has changed.
  /// @param range of the colours of the scene's lines.
  /// @pre view.probe.
  /// @return whether the path is another one, and not only longer.
  bool update(const SceneView& view, const SceneFrame& frame, const ValueRange& range);

  /// Whether some force along the path lies above its range.
  [[nodiscard]] bool forces_above() const noexcept { return trail_.above_range(); }

  /// Draws the path from point `first` on as far as it stays as it is while it grows.
  /// @param unit pixels in a thousandth of the picture's height.
  /// @return the point to go on from when it has grown.
  std::size_t draw_settled_path(LineProgram& program, const SceneView& view, float unit,
                                std::size_t first) const;
  /// Draws the last bit of the path, which still changes.
  void draw_path_end(LineProgram& program, const SceneView& view, float unit) const;

  /// Draws again, faintly, what is in sight of what shines through nearer things: over a volume, which may
  /// lie before it. Without depth. Parameters as of draw().
  void draw_through(LineProgram& program, const SceneView& view, const LineDraw& base, float unit);

  /// Draws all but the path.
  /// @param base tolerance and direction of the scene's lines.
  void draw(LineProgram& program, const SceneView& view, const LineDraw& base, float unit);

 private:
  void draw_path(LineProgram& program, const SceneView& view, float unit, std::size_t first,
                 std::size_t last) const;
  void upload_followed(const SceneView& view, const SceneFrame& frame, const ValueRange& range);
  void upload_seeds(const SceneView& view, const SceneFrame& frame, const ValueRange& range);
  [[nodiscard]] Rgb kept_color(std::size_t i) const;
  void upload_cached(const SceneView& view, const SceneFrame& frame);

  LineSet followed_, seeds_;
  std::vector<LineSet> kept_;  // one a line: each has its own colour
  LineTrail trail_;
  SpherePass sphere_pass_;
  ArrowPass arrow_pass_;
  TensorGlyphMesh tensor_mesh_;
  ProbeGlyphs glyphs_;

  // What the buffers were made from.
  SceneFrame frame_;
  ValueRange range_;
  std::optional<LineStyle> style_;
  std::shared_ptr<const FollowedLine> shown_followed_;
  std::shared_ptr<const LocalSeeds> shown_seeds_;
  std::shared_ptr<const std::vector<DrawnLine>> shown_kept_;
  bool followed_has_values_ = false;
};

}  // namespace palpate
