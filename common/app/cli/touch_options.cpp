#include "common/app/cli/touch_options.h"

#include <charconv>

#include "common/app/haptic/haptic_mode.h"
#include "common/base/error.h"

namespace palpate {
namespace {

constexpr double kMetresPerMillimetre = 1e-3;

}  // namespace

Workspace touch_workspace(const TouchOptions& options, const VectorField& field) {
  const double scale =
      options.workspace_scale > 0.0 ? options.workspace_scale : Workspace::default_scale(field.diagonal());
  return {scale, field.frame()};
}

ChainSettings touch_settings(const TouchOptions& options) {
  ChainSettings settings{.stiffness = options.stiffness,
                         .release_distance = kMetresPerMillimetre * options.release,
                         .drag_threshold = kMetresPerMillimetre * options.drag,
                         .tick_stiffness = options.tick_stiffness,
                         .speed_force = options.speed_force};
  if (wants_ticks(options) && options.ticks != "auto") {
    const char* const end = options.ticks.data() + options.ticks.size();
    const auto parsed = std::from_chars(options.ticks.data(), end, settings.tick_interval);
    if (parsed.ec != std::errc() || parsed.ptr != end || !(settings.tick_interval >= 0.0)) {
      throw usage_error("--ticks: 'auto' or a time in data units is expected, found '" + options.ticks + "'");
    }
  }
  if (!settings.valid()) {
    throw usage_error("--release must be above 0 mm, and all of stiffness, drag, ticks and forces finite");
  }
  return settings;
}

ChainSettings touch_settings(const TouchOptions& options, const VectorField& field,
                             const Workspace& workspace) {
  ChainSettings settings = touch_settings(options);
  if (wants_ticks(options) && settings.tick_interval == 0.0) {
    settings.tick_interval = default_tick_interval(field, workspace);
  }
  return settings;
}

DeviceLimits touch_limits(const TouchOptions& options) {
  DeviceLimits limits;
  limits.force_cap = options.force_cap;
  limits.slew_cap = options.slew_cap;
  if (!limits.valid()) throw usage_error("--force-cap and --slew-cap must be above zero");
  return limits;
}

}  // namespace palpate
