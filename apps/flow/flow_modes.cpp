#include "apps/flow/flow_modes.h"

#include <utility>

#include "common/field/scalar_threshold.h"
#include "common/hand/mode/linear_mode.h"
#include "common/haptics/constraint/isosurface.h"
#include "common/haptics/constraint/isotropic_drag.h"
#include "common/haptics/constraint/streamline.h"
#include "common/haptics/constraint/tick_marks.h"
#include "common/haptics/force_field/force_field.h"

namespace palpate {
namespace {

HapticChain make_streamline(const HapticScene& scene) {
  auto line = std::make_shared<LiveLine>(scene.field, LiveLine::kFollowTolerance, scene.threads);
  auto streamline = std::make_unique<StreamlineConstraint>(line, scene.workspace);
  const StreamlineConstraint& followed = *streamline;
  std::vector<std::unique_ptr<Constraint>> links;
  links.push_back(std::move(streamline));
  // Without tick marks the chain ends with the streamline's proxy, which is then the one that is logged.
  if (scene.settings.ticks.interval > 0.0) links.push_back(std::make_unique<TickMarks>(followed));
  HapticChain made;
  made.chain = std::make_unique<ProxyChain>(std::move(links), scene.settings);
  made.followed = std::move(line);
  return made;
}

/// A chain of `link` alone.
HapticChain single(std::unique_ptr<Constraint> link, const HapticScene& scene) {
  std::vector<std::unique_ptr<Constraint>> links;
  links.push_back(std::move(link));
  HapticChain made;
  made.chain = std::make_unique<ProxyChain>(std::move(links), scene.settings);
  return made;
}

/// What is felt of a scalar: the speed unless another one was chosen.
std::shared_ptr<const ScalarField> scalar_of(const HapticScene& scene) {
  return scene.scalar ? scene.scalar : make_speed_field(scene.field);
}

HapticChain make_isotropic(const HapticScene& scene) {
  return single(std::make_unique<IsotropicDrag>(), scene);
}
HapticChain make_direct(const HapticScene& scene) {
  return single(std::make_unique<DirectDisplay>(scene.field, scene.workspace), scene);
}
HapticChain make_transverse(const HapticScene& scene) {
  return single(std::make_unique<TransverseDamping>(scene.field, scene.workspace), scene);
}
HapticChain make_vortex(const HapticScene& scene) {
  return single(std::make_unique<VortexPull>(scene.field, scene.workspace), scene);
}
HapticChain make_density(const HapticScene& scene) {
  return single(std::make_unique<DensityDrag>(scalar_of(scene), scene.workspace), scene);
}

/// The isosurface alone, or a streamline whose proxy meets it (Ikits 2006, figure 6.7).
HapticChain make_isosurface(const HapticScene& scene) {
  HapticChain made;
  std::vector<std::unique_ptr<Constraint>> links;
  if (scene.settings.isosurface.along_streamline) {
    auto line = std::make_shared<LiveLine>(scene.field, LiveLine::kFollowTolerance, scene.threads);
    links.push_back(std::make_unique<StreamlineConstraint>(line, scene.workspace));
    made.followed = std::move(line);
  }
  const auto scalar = scalar_of(scene);
  made.surfaces_of = scalar;
  made.isovalues = {{otsu_threshold(*scalar)}, 1};
  links.push_back(std::make_unique<IsosurfaceConstraint>(scalar, scene.workspace, made.isovalues));
  made.chain = std::make_unique<ProxyChain>(std::move(links), scene.settings);
  return made;
}

}  // namespace

std::vector<HapticMode> flow_modes() {
  return {
      {"streamline", "held by the streamline, which gives when pushed and pops over to the next",
       make_streamline},
      {"isotropic", "the same drag in all directions, to steady the hand", make_isotropic},
      {"direct", "carried along by the flow, the harder the faster it is", make_direct},
      {"transverse", "dragged when moving across the flow, free along it", make_transverse},
      {"vortex", "pulled to the cores of vortices", make_vortex},
      {"density", "dragged the more, the higher the scalar: the speed unless another is chosen",
       make_density},
      {kIsosurfaceMode, "stopped by surfaces of equal value, of the speed unless another scalar is chosen",
       make_isosurface},
      linear_mode()};
}

}  // namespace palpate
