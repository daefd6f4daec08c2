/// The lines of a scene, its outline and its regions, uploaded: again only where they are others.
#pragma once

#include <memory>
#include <vector>

#include "common/render/line/line_layers.h"
#include "common/render/line/line_pass.h"
#include "common/render/scene_view.h"

namespace palpate {

/// Needs the same OpenGL context at every call and at destruction.
class SceneGeometry {
 public:
  /// @return whether something is another one than at the call before.
  bool update(const SceneView& view);
  /// With the lines' colours and legend, which others set.
  [[nodiscard]] ColoredLines& lines() noexcept { return lines_; }
  [[nodiscard]] LineSet& outline() noexcept { return outline_; }
  /// One a region of the view.
  [[nodiscard]] std::vector<LineSet>& regions() noexcept { return regions_; }
  /// Of the last view: where all of it lies [data units] (reach_of()), and the frame that it is drawn in.
  [[nodiscard]] const Box& reach() const noexcept { return reach_; }
  [[nodiscard]] const SceneFrame& frame() const noexcept { return frame_; }

 private:
  ColoredLines lines_;
  LineSet outline_;
  std::vector<LineSet> regions_;
  Box reach_;
  SceneFrame frame_;

  // What these were made from.
  bool filled_ = false;
  std::shared_ptr<const std::vector<Line>> shown_lines_;
  Box shown_bounds_;
  std::shared_ptr<const TensorVoxels> shown_tensors_;
  std::shared_ptr<const TractBundle> shown_tracts_;
  std::vector<std::vector<Vec3>> shown_outline_;
  std::vector<RegionView> shown_regions_;
};

}  // namespace palpate
