#include "common/hand/haptic_surface_view.h"

#include <memory>
#include <vector>

#include "common/base/index.h"
#include "common/base/text.h"
#include "common/field/value_histogram.h"
#include "common/hand/mode/haptic_mode.h"
#include "common/hand/mode/haptic_surfaces.h"
#include "common/hand/touch_options.h"
#include "common/trace/isosurface/isosurface_mesh.h"

namespace palpate {

bool wants_surfaces(const Document& options, const std::string& mode) {
  if (options.touch.show_surfaces == false) return false;
  const bool haptic = !options.touch.mode.empty() || !options.hand.path.empty();
  return !options.touch.isovalues.empty() || (haptic && mode == kIsosurfaceMode);
}

std::string show_haptic_surfaces(SceneView& view, const ScalarField& field, const TouchOptions& options,
                                 Progress* progress) {
  constexpr std::size_t kMostTriangles = 4'000'000;
  Isovalues isovalues = touch_settings(options).isosurface.isovalues;
  if (isovalues.count == 0) isovalues = {{otsu_threshold(field)}, 1};
  std::vector<std::shared_ptr<const IsosurfaceMesh>> meshes;
  std::string words;
  for (int i = 0; i < isovalues.count; ++i) {
    const double level = isovalues.value[as_size(i)];
    meshes.push_back(
        std::make_shared<const IsosurfaceMesh>(make_isosurface_mesh(field, level, kMostTriangles, progress)));
    words += (i > 0 ? ", " : " at ") + short_number(level);
  }
  view.surfaces = show_surfaces(meshes);
  view.subtitle += (meshes.size() > 1 ? ", isosurfaces of " : ", isosurface of ") + field.name() + words;
  return beyond_values(field, isovalues);
}

}  // namespace palpate
