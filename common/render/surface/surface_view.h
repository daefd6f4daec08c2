/// What a picture shows of isosurfaces, as plain data.
#pragma once

#include <memory>
#include <vector>

#include "common/render/color/color_map.h"
#include "common/render/probe_view.h"
#include "common/trace/isosurface/isosurface_mesh.h"

namespace palpate {

struct SurfaceView {
  std::shared_ptr<const IsosurfaceMesh> mesh;  ///< may be null
  Rgb color{0.86F, 0.80F, 0.70F};
  /// Share of a pixel's samples that it covers, in (0, 1].
  double opacity = 1.0;
  /// A number a point of the mesh, coloured as SceneView::style colours lines; null: `color` does.
  std::shared_ptr<const std::vector<float>> values;
  /// Likewise inside SceneView::color_lens; null: as outside.
  std::shared_ptr<const std::vector<float>> lens_values;
  double contours = 0.0;  ///< distance of lines of equal value, at its multiples; 0: none

  bool operator==(const SurfaceView&) const = default;
};

/// The surfaces of a set, as they are shown together: one alone opaque, several in colours of their own and
/// half covering.
/// @param meshes may be null each.
[[nodiscard]] inline std::vector<SurfaceView> show_surfaces(
    const std::vector<std::shared_ptr<const IsosurfaceMesh>>& meshes) {
  constexpr double kHalf = 0.5;
  std::vector<SurfaceView> surfaces;
  for (const auto& mesh : meshes) {
    SurfaceView surface{.mesh = mesh};
    if (meshes.size() > 1) {
      surface.color = cached_color(static_cast<int>(surfaces.size()) + 1);
      surface.opacity = kHalf;
    }
    surfaces.push_back(std::move(surface));
  }
  return surfaces;
}

}  // namespace palpate
