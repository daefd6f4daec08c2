#include "common/hand/mode/haptic_mode.h"

#include <algorithm>
#include <utility>

#include "common/base/error.h"

namespace palpate {

// Each is defined in the file of its mode.
#define PALPATE_MODE(make, ...) HapticChain make(const HapticScene& scene);
#include "common/hand/mode/modes.def"
#undef PALPATE_MODE

std::vector<HapticMode> modes_of(FieldKind kind) {
#define PALPATE_MODE(function, ...) with_maker(HapticMode{__VA_ARGS__}, function),
  const auto with_maker = [](HapticMode mode, HapticChain (*make)(const HapticScene&)) {
    mode.make = make;
    return mode;
  };
  std::vector<HapticMode> modes{
#include "common/hand/mode/modes.def"
  };
#undef PALPATE_MODE
  std::erase_if(modes, [kind](const HapticMode& mode) {
    return std::find(mode.fields.begin(), mode.fields.end(), kind) == mode.fields.end();
  });
  return modes;
}

HapticChain make_chain(const HapticMode& mode, const HapticScene& scene) {
  HapticChain made = mode.make(scene);
  if (scene.fixtures.empty()) return made;
  add_fixtures(*made.chain, scene.fixtures, scene.workspace);
  made.fixtures = scene.fixtures;
  return made;
}

HapticChain chain_of(std::unique_ptr<Constraint> link, const HapticScene& scene) {
  std::vector<std::unique_ptr<Constraint>> links;
  links.push_back(std::move(link));
  HapticChain made;
  made.chain = std::make_unique<ProxyChain>(std::move(links), scene.settings);
  return made;
}

std::shared_ptr<const ScalarField> scalar_or_speed(const HapticScene& scene) {
  return scene.scalar ? scene.scalar : make_speed_field(scene.field);
}

const HapticMode& find_mode(std::span<const HapticMode> modes, const std::string& name) {
  if (name.empty()) return modes.front();
  std::string known;
  for (const HapticMode& mode : modes) {
    if (mode.name == name) return mode;
    known += (known.empty() ? "" : ", ") + mode.name;
  }
  throw usage_error("unknown mode '" + name + "'; known are " + known);
}

double default_tick_interval(const VectorField& field, const Workspace& workspace) noexcept {
  constexpr double kSpacing = 0.010;  // [m]
  const double speed = field.max_speed() * workspace.scale();
  return speed > 0.0 ? kSpacing / speed : 0.0;
}

}  // namespace palpate
