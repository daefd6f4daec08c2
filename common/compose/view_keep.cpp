#include "common/compose/view_keep.h"

#include <cmath>
#include <cstddef>

#include "common/compose/lens_text.h"
#include "common/compose/line_view.h"
#include "common/compose/plane_image_text.h"
#include "common/math/vec_text.h"
#include "common/scene/session_of.h"

namespace palpate {

void keep_camera(const SceneView& view, Document& document) {
  const Camera& camera = view.camera;
  document.view.camera = camera_text(camera, view.bounds, kSessionAspect);
  document.view.focal =
      camera.focal_point == view.bounds.center() ? std::string() : exact_text(camera.focal_point);
  document.volume.projection =
      camera.projection == Projection::kOrthographic ? "orthographic" : "perspective";
}

void keep_lines(const LineStyle& style, Document& document) {
  document.view.line_width = style.width;
  document.view.line_opacity = style.opacity;
}

void cache_volume(const VolumeView& volume, Document& document) {
  VolumeOptions& kept = document.volume;
  kept.clips.clear();  // cuts are among the lenses
  kept.lenses = lens_texts(volume);
  kept.samples = volume.samples_per_voxel;
  kept.far_sampling = volume.far_sampling;
  kept.context_viewport = volume.context.viewport;
  kept.context_level = volume.context.level;
  kept.gpu_memory = std::ldexp(static_cast<double>(volume.storage.memory), -20);
  kept.tables = kTableMakerNames[static_cast<std::size_t>(volume.table_maker)];
  kept.shading = volume.shading;
  const PlaneImages& planes = volume.planes;
  kept.plane_image = planes.shown;
  kept.window.reset();
  kept.level.reset();
  if (planes.window) {
    kept.window = planes.window->width;
    kept.level = planes.window->level;
  }
  kept.contours = contours_text(planes.contours);
}

}  // namespace palpate
