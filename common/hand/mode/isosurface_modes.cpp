// The mode `isosurface`, in a flow and in a volume.
#include <utility>

#include "common/field/value_histogram.h"
#include "common/hand/mode/haptic_mode.h"
#include "common/hand/mode/texture_link.h"
#include "common/haptics/constraint/isosurface.h"
#include "common/haptics/constraint/streamline.h"
#include "common/haptics/constraint/surface_friction.h"

namespace palpate {

/// The isosurface alone, or a streamline whose proxy meets it (Ikits 2006, figure 6.7).
HapticChain make_isosurface_in_flow(const HapticScene& scene) {
  HapticChain made;
  std::vector<std::unique_ptr<Constraint>> links;
  if (scene.settings.isosurface.along_streamline) {
    auto line = std::make_shared<LiveLine>(scene.field, LiveLine::kFollowTolerance, scene.threads);
    links.push_back(std::make_unique<StreamlineConstraint>(line, scene.workspace));
    made.followed = std::move(line);
  }
  const auto scalar = scalar_or_speed(scene);
  made.surfaces_of = scalar;
  made.isovalues = {{otsu_threshold(*scalar)}, 1};
  auto surface = std::make_unique<IsosurfaceConstraint>(scalar, scene.workspace, made.isovalues);
  const IsosurfaceConstraint& rubbed = *surface;
  links.push_back(std::move(surface));
  if (scene.settings.contact.rubs()) links.push_back(std::make_unique<SurfaceFriction>(rubbed));
  made.chain = std::make_unique<ProxyChain>(std::move(links), scene.settings);
  return made;
}

HapticChain make_isosurface(const HapticScene& scene) {
  const Isovalues otherwise{{otsu_threshold(*scene.scalar)}, 1};
  auto surface = std::make_unique<IsosurfaceConstraint>(scene.scalar, scene.workspace, otherwise);
  const IsosurfaceConstraint* const its = surface.get();
  std::vector<std::unique_ptr<Constraint>> links;
  links.push_back(std::move(surface));
  if (scene.settings.contact.rubs()) links.push_back(std::make_unique<SurfaceFriction>(*its));
  HapticChain made;
  made.noise = add_texture(links, scene, its);
  made.chain = std::make_unique<ProxyChain>(std::move(links), scene.settings);
  made.surfaces_of = scene.scalar;
  made.isovalues = otherwise;
  return made;
}

}  // namespace palpate
