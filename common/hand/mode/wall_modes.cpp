// The modes of the wall of a heart: a layer of it, and on that the fibres. Their scenes have the depth as scalar and
// the fibres as tensor.
#include <utility>

#include "common/hand/mode/haptic_mode.h"
#include "common/haptics/constraint/fibre_groove.h"
#include "common/haptics/constraint/layer.h"
#include "common/haptics/constraint/surface_friction.h"

namespace palpate {
namespace {

/// How many proxies: on the layer, in the groove, dragged along it.
enum class WallLinks : unsigned char { kLayer = 1, kGroove = 2, kFriction = 3 };

HapticChain make_wall(const HapticScene& scene, WallLinks links) {
  HapticChain made;
  made.surfaces_of = scene.scalar;
  made.isovalues = default_layers(*scene.scalar);
  auto layer = std::make_unique<LayerConstraint>(scene.scalar, scene.workspace, made.isovalues);
  const LayerConstraint& on = *layer;
  std::vector<std::unique_ptr<Constraint>> chain;
  chain.push_back(std::move(layer));
  if (links == WallLinks::kLayer && scene.settings.contact.rubs())
    chain.push_back(std::make_unique<SurfaceFriction>(on.surface()));
  if (links != WallLinks::kLayer) {
    const auto heart =
        std::make_shared<const LayeredHeart>(Heart{.fibres = scene.tensor, .layer = scene.scalar});
    auto groove = std::make_unique<FibreGroove>(heart, on);
    const FibreGroove& in = *groove;
    chain.push_back(std::move(groove));
    if (links == WallLinks::kFriction) chain.push_back(std::make_unique<FibreFriction>(heart, on, in));
  }
  made.chain = std::make_unique<ProxyChain>(std::move(chain), scene.settings);
  return made;
}

}  // namespace

HapticChain make_fibre(const HapticScene& scene) { return make_wall(scene, WallLinks::kGroove); }
HapticChain make_layer(const HapticScene& scene) { return make_wall(scene, WallLinks::kLayer); }
HapticChain make_friction(const HapticScene& scene) { return make_wall(scene, WallLinks::kFriction); }

}  // namespace palpate
