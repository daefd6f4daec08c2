#include "apps/dtmri/dtmri_modes.h"

#include <utility>

#include "common/haptics/constraint/anisotropy_drag.h"

namespace palpate {
namespace {

HapticChain make_anisotropy(const HapticScene& scene, IsotropicPlaces isotropic) {
  std::vector<std::unique_ptr<Constraint>> links;
  links.push_back(std::make_unique<AnisotropyDrag>(scene.tensor, scene.workspace, isotropic));
  HapticChain made;
  made.chain = std::make_unique<ProxyChain>(std::move(links), scene.settings);
  return made;
}

}  // namespace

std::vector<HapticMode> dtmri_modes() {
  return {{"anisotropy",
           "held to the main direction of diffusion, to a plane where it is planar, free where "
           "it is isotropic",
           [](const HapticScene& scene) { return make_anisotropy(scene, IsotropicPlaces::kFree); }},
          {"anisotropy-point", "the same, but held to a point where diffusion is isotropic",
           [](const HapticScene& scene) { return make_anisotropy(scene, IsotropicPlaces::kPoint); }}};
}

}  // namespace palpate
