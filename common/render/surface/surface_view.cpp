#include "common/render/surface/surface_view.h"

#include "common/render/probe_view.h"

namespace palpate {

std::vector<SurfaceView> show_surfaces(const std::vector<std::shared_ptr<const IsosurfaceMesh>>& meshes) {
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
