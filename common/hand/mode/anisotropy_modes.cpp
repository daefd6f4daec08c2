// The modes of diffusion tensors: the drag that its anisotropy leaves free.
#include <utility>

#include "common/hand/mode/haptic_mode.h"
#include "common/haptics/constraint/anisotropy_drag.h"

namespace palpate {

HapticChain make_anisotropy(const HapticScene& scene) {
  return chain_of(std::make_unique<AnisotropyDrag>(scene.tensor, scene.workspace, IsotropicPlaces::kFree),
                  scene);
}

HapticChain make_anisotropy_point(const HapticScene& scene) {
  return chain_of(std::make_unique<AnisotropyDrag>(scene.tensor, scene.workspace, IsotropicPlaces::kPoint),
                  scene);
}

}  // namespace palpate
