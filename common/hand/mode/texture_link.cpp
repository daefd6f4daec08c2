#include "common/hand/mode/texture_link.h"

#include <utility>

#include "common/base/error.h"
#include "common/field/noise_field.h"
#include "common/haptics/constraint/noise_texture.h"
#include "common/math/units.h"

namespace palpate {

std::shared_ptr<const ScalarField> add_texture(std::vector<std::unique_ptr<Constraint>>& links,
                                               const HapticScene& scene,
                                               const IsosurfaceConstraint* surface) {
  if (!scene.settings.texture.by_noise || !scene.scalar) return nullptr;
  std::shared_ptr<const ScalarField> noise =
      scene.noise ? scene.noise : make_noise_field(*scene.scalar, scene.threads);
  if (noise) links.push_back(std::make_unique<NoiseTexture>(noise, scene.workspace, surface));
  return noise;
}

HapticChain textured_chain(std::unique_ptr<Constraint> link, const HapticScene& scene) {
  std::vector<std::unique_ptr<Constraint>> links;
  links.push_back(std::move(link));
  HapticChain made;
  made.noise = add_texture(links, scene);
  made.chain = std::make_unique<ProxyChain>(std::move(links), scene.settings);
  return made;
}

TextureSettings texture_settings(const std::string& text) {
  TextureSettings settings{.by_noise = text != "off"};
  if (text == "off" || text == "on") return settings;
  const auto problem = HapticTransferFunction::read(text, settings.grain, kMetresPerMillimetre);
  if (problem)
    throw usage_error("--noise-texture: off, on, or a curve NOISE:MM,NOISE:MM is expected: " + *problem);
  if (!settings.valid()) throw usage_error("--noise-texture: grains of zero or more in mm are expected");
  return settings;
}

std::string texture_text(const TextureSettings& settings) {
  if (!settings.by_noise) return "off";
  return settings.grain == TextureSettings{}.grain ? "on" : settings.grain.text(kMetresPerMillimetre);
}

}  // namespace palpate
