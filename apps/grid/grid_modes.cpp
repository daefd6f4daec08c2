#include "apps/grid/grid_modes.h"

#include <utility>

#include "common/field/scalar_threshold.h"
#include "common/hand/mode/grid_mode.h"
#include "common/hand/mode/linear_mode.h"
#include "common/hand/mode/texture_link.h"
#include "common/haptics/constraint/isosurface.h"
#include "common/haptics/force_field/force_field.h"

namespace palpate {
namespace {

/// A chain of `link` alone, or with a texture.
/// @param surface the same link, where only that has the texture.
HapticChain single(std::unique_ptr<Constraint> link, const HapticScene& scene,
                   const IsosurfaceConstraint* surface = nullptr) {
  std::vector<std::unique_ptr<Constraint>> links;
  links.push_back(std::move(link));
  HapticChain made;
  made.noise = add_texture(links, scene, surface);
  made.chain = std::make_unique<ProxyChain>(std::move(links), scene.settings);
  return made;
}

HapticChain make_isosurface(const HapticScene& scene) {
  const Isovalues otherwise{{otsu_threshold(*scene.scalar)}, 1};
  auto surface = std::make_unique<IsosurfaceConstraint>(scene.scalar, scene.workspace, otherwise);
  const IsosurfaceConstraint* const its = surface.get();
  HapticChain made = single(std::move(surface), scene, its);
  made.surfaces_of = scene.scalar;
  made.isovalues = otherwise;
  return made;
}
HapticChain make_density(const HapticScene& scene) {
  return single(std::make_unique<DensityDrag>(scene.scalar, scene.workspace), scene);
}

}  // namespace

std::vector<HapticMode> grid_modes() {
  return {grid_mode(),
          plane_widget_mode(),
          {"isosurface", "stopped by surfaces of equal value, which give when pushed hard", make_isosurface},
          {"density", "dragged the more, the higher the value", make_density},
          linear_mode()};
}

}  // namespace palpate
