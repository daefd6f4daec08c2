#include "common/hand/mode/haptic_mode.h"

#include "common/base/error.h"

namespace palpate {

const HapticMode& find_mode(std::span<const HapticMode> modes, const std::string& name) {
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
