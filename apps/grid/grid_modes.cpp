#include "apps/grid/grid_modes.h"

#include <utility>

#include "common/haptics/constraint/isotropic_drag.h"

namespace palpate {
namespace {

HapticChain make_isotropic(const HapticScene& scene) {
  std::vector<std::unique_ptr<Constraint>> links;
  links.push_back(std::make_unique<IsotropicDrag>());
  HapticChain made;
  made.chain = std::make_unique<ProxyChain>(std::move(links), scene.settings);
  return made;
}

}  // namespace

std::vector<HapticMode> grid_modes() {
  return {{"isotropic", "the same drag in all directions, to steady the hand", make_isotropic}};
}

}  // namespace palpate
