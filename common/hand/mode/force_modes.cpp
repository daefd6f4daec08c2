// Modes that hold the hand to no feature: nothing at all, the same drag everywhere, and the force fields of a flow or a scalar.
#include <utility>

#include "common/hand/mode/haptic_mode.h"
#include "common/hand/mode/texture_link.h"
#include "common/haptics/constraint/anisotropy_drag.h"
#include "common/haptics/force_field/force_field.h"

namespace palpate {

HapticChain make_free(const HapticScene& scene) {
  HapticChain made;
  made.chain = std::make_unique<ProxyChain>(std::vector<std::unique_ptr<Constraint>>{}, scene.settings);
  return made;
}

HapticChain make_isotropic(const HapticScene& scene) {
  return chain_of(std::make_unique<IsotropicDrag>(), scene);
}

HapticChain make_direct(const HapticScene& scene) {
  return chain_of(std::make_unique<DirectDisplay>(scene.field, scene.workspace), scene);
}

HapticChain make_transverse(const HapticScene& scene) {
  return chain_of(std::make_unique<TransverseDamping>(scene.field, scene.workspace), scene);
}

HapticChain make_vortex(const HapticScene& scene) {
  return chain_of(std::make_unique<VortexPull>(scene.field, scene.workspace), scene);
}

HapticChain make_density_of_flow(const HapticScene& scene) {
  return chain_of(std::make_unique<DensityDrag>(scalar_or_speed(scene), scene.workspace), scene);
}

HapticChain make_density(const HapticScene& scene) {
  return textured_chain(std::make_unique<DensityDrag>(scene.scalar, scene.workspace), scene);
}

}  // namespace palpate
