#include "common/hand/touch_options.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>

#include "common/base/error.h"
#include "common/base/index.h"
#include "common/base/text.h"
#include "common/hand/mode/grid_mode.h"
#include "common/hand/mode/haptic_mode.h"
#include "common/hand/mode/linear_mode.h"
#include "common/hand/mode/texture_link.h"
#include "common/haptics/proxy_chain.h"
#include "common/math/units.h"
#include "common/scene/document/setting.h"
#include "common/scene/session.h"

namespace palpate {
namespace {

/// From how many links on a chain is under the passivity controller.
double links_to_control(const std::string& passivity) {
  if (passivity == "auto") return PassivitySettings{}.from_links;
  if (passivity == "on") return 1.0;
  if (passivity == "off") return ChainStep::kMaxLinks + 1.0;
  throw usage_error("--passivity: auto, on or off is expected, found '" + passivity + "'");
}

IsosurfaceSettings isosurface_settings(const TouchOptions& options) {
  IsosurfaceSettings settings{.depth = kMetresPerMillimetre * options.depth,
                              .snap_distance = kMetresPerMillimetre * options.snap,
                              .along_streamline = options.along_streamline};
  if (!options.isovalues.empty()) {
    for (const std::string_view word : split(options.isovalues, ',')) {
      double value = 0.0;
      const auto parsed = std::from_chars(word.data(), word.data() + word.size(), value);
      if (parsed.ec != std::errc() || parsed.ptr != word.data() + word.size() || !std::isfinite(value)) {
        throw usage_error("--isovalue: numbers with commas between are expected, found '" +
                          options.isovalues + "'");
      }
      // One that is named twice is one surface.
      Isovalues& all = settings.isovalues;
      const auto end = all.value.begin() + all.count;
      if (std::find(all.value.begin(), end, value) != end) continue;
      if (all.count == Isovalues::kMax) throw usage_error("--isovalue: at most eight values are taken");
      all.value[as_size(all.count++)] = value;
    }
  }
  bool known = false;
  for (int i = 0; i < kIsosurfaceHoldCount && !known; ++i) {
    settings.hold = static_cast<IsosurfaceHold>(i);
    known = options.surface == name_of(settings.hold);
  }
  if (!known) {
    throw usage_error("--surface: wall, below, above or layer is expected, found '" + options.surface + "'");
  }
  if (!(settings.depth > 0.0)) throw usage_error("--depth: a number above zero is expected");
  if (!(settings.snap_distance <= settings.depth)) {
    throw usage_error("--snap: a distance no larger than --depth is expected");
  }
  return settings;
}

void take_fixtures(const FixtureSpec& spec, ChainSettings& settings) {
  settings.shape = {.snap_distance = kMetresPerMillimetre * spec.snap,
                    .release_distance = kMetresPerMillimetre * spec.release};
  settings.carry = {.speed = kMetresPerMillimetre * spec.carry, .force = spec.carry_force};
  settings.contact = {.sticking = spec.static_friction,
                      .sliding = spec.dynamic_friction,
                      .grain = kMetresPerMillimetre * spec.grain};
  settings.viscosity = spec.viscosity;
  settings.even_stiffness = spec.even_stiffness;
  settings.events = {.force = spec.event_force, .frequency = spec.event_frequency};
  if (!settings.shape.valid())
    throw usage_error(
        "--fixture-release: a distance above zero, no smaller than --fixture-snap, is expected");
  if (!settings.carry.valid()) throw usage_error("--carry: a speed and a force of zero or more are expected");
  if (!settings.contact.valid())
    throw usage_error("--dynamic-friction: a number from zero to --static-friction is expected");
  if (!settings.events.valid()) throw usage_error("--event-force: a force of zero or more is expected");
}

void keep_fixtures(const ChainSettings& settings, FixtureSpec& spec) {
  constexpr double kMillimetres = 1e3;
  spec.snap = kMillimetres * settings.shape.snap_distance;
  spec.release = kMillimetres * settings.shape.release_distance;
  spec.carry = kMillimetres * settings.carry.speed;
  spec.carry_force = settings.carry.force;
  spec.static_friction = settings.contact.sticking;
  spec.dynamic_friction = settings.contact.sliding;
  spec.grain = kMillimetres * settings.contact.grain;
  spec.viscosity = settings.viscosity;
  spec.even_stiffness = settings.even_stiffness;
  spec.event_force = settings.events.force;
  spec.event_frequency = settings.events.frequency;
}

SeedShape seed_shape_of(const TouchOptions& options) {
  const auto name = std::ranges::find(kSeedShapeNames, options.local_lines);
  if (name == kSeedShapeNames.end())
    throw usage_error("--local-lines " + options.local_lines + ": none, rake, plane are known");
  return static_cast<SeedShape>(name - kSeedShapeNames.begin());
}

}  // namespace

Workspace touch_workspace(const TouchOptions& options, double diagonal, const LocalFrame& frame) {
  const double scale =
      options.workspace_scale > 0.0 ? options.workspace_scale : Workspace::default_scale(diagonal);
  return {scale, frame};
}

ChainSettings touch_settings(const TouchOptions& options) {
  ChainSettings settings;
  settings.stiffness = options.stiffness;
  settings.damping = options.damping;
  settings.passivity.from_links = links_to_control(options.passivity);
  settings.streamline = {.release_distance = kMetresPerMillimetre * options.release,
                         .speed_force = options.speed_force};
  settings.drag.threshold = kMetresPerMillimetre * options.drag;
  settings.isosurface = isosurface_settings(options);
  settings.fibre = {.spacing = kMetresPerMillimetre * options.fibre_spacing,
                    .least_friction = kMetresPerMillimetre * options.least_friction,
                    .most_friction = kMetresPerMillimetre * options.most_friction};
  settings.ticks.stiffness = options.tick_stiffness;
  settings.linear = linear_settings(options.linear);
  settings.texture = texture_settings(options.noise_texture);
  settings.grid_axis = grid_settings(options.grid);
  settings.plane_widget = plane_settings(options.planes);
  settings.force_field.strength = options.field_force;
  settings.force_field.damping = options.field_damping;
  take_fixtures(options.fixtures, settings);
  if (!options.density_curve.empty()) {
    const auto problem = HapticTransferFunction::read(options.density_curve, settings.force_field.density);
    if (problem) throw usage_error("--density-curve: " + *problem);
    if (!settings.force_field.valid()) throw usage_error("--density-curve: parts from 0 to 1 are expected");
  }
  if (!options.anisotropy_curve.empty()) {
    const auto problem =
        HapticTransferFunction::read(options.anisotropy_curve, settings.anisotropy.tau, kMetresPerMillimetre);
    if (problem) throw usage_error("--anisotropy-curve: " + *problem);
    if (!settings.anisotropy.valid()) {
      throw usage_error(
          "--anisotropy-curve: 0 mm at anisotropy 0, and never falling from there, is expected, "
          "found '" +
          options.anisotropy_curve + "'");
    }
  }
  if (wants_ticks(options) && options.ticks != "auto") {
    const char* const end = options.ticks.data() + options.ticks.size();
    const auto parsed = std::from_chars(options.ticks.data(), end, settings.ticks.interval);
    if (parsed.ec != std::errc() || parsed.ptr != end || !(settings.ticks.interval >= 0.0)) {
      throw usage_error("--ticks: 'auto' or a time in data units is expected, found '" + options.ticks + "'");
    }
  }
  if (!std::isfinite(settings.damping) || settings.damping < 0.0) {
    throw usage_error("--damping: a number of zero or more is expected");
  }
  if (!(settings.fibre.spacing > 0.0)) throw usage_error("--fibre-spacing: a number above zero is expected");
  if (!settings.fibre.valid())
    throw usage_error("--most-friction: a distance no smaller than --least-friction is expected");
  if (!(settings.streamline.release_distance > 0.0))
    throw usage_error("--release: a number above zero is expected");
  if (!std::isfinite(settings.ticks.interval)) throw usage_error("--ticks: a finite time is expected");
  if (!(settings.ticks.stiffness >= 0.0 && settings.ticks.stiffness <= 1.0)) {
    throw usage_error("--tick-stiffness: a number from 0 to 1 is expected");
  }
  if (!std::isfinite(settings.streamline.speed_force))
    throw usage_error("--speed-force: a finite force is expected");
  if (!std::isfinite(settings.force_field.strength)) {
    throw usage_error("--field-force: a finite force is expected");
  }
  return settings;
}

TouchChoice touch_choice(const TouchOptions& options, const std::vector<HapticMode>& modes, TouchChoice now) {
  if (!options.mode.empty()) now.mode = as_size(&find_mode(modes, options.mode) - modes.data());
  const int edit = now.settings.plane_widget.edit;
  now.settings = touch_settings(options);
  now.settings.plane_widget.edit = edit;
  now.fixtures = options.fixtures.list;
  now.ticks = wants_ticks(options);
  now.stroke = stroke_use_from_name(options.stroke);
  now.show_surface = options.show_surfaces;
  now.show_path = options.show_path;
  now.show_balls = options.stream_balls;
  now.fade_rest = options.fade_lines;
  now.local = seed_shape_of(options);
  return now;
}

void keep_touch(const TouchChoice& choice, const std::string& mode, TouchOptions& options) {
  constexpr double kMillimetres = 1e3;
  const ChainSettings& settings = choice.settings;
  const IsosurfaceSettings& surface = settings.isosurface;
  options.mode = mode;
  options.stiffness = settings.stiffness;
  options.damping = settings.damping;
  options.release = kMillimetres * settings.streamline.release_distance;
  options.speed_force = settings.streamline.speed_force;
  options.drag = kMillimetres * settings.drag.threshold;
  options.tick_stiffness = settings.ticks.stiffness;
  options.ticks.clear();
  if (choice.ticks)
    options.ticks = settings.ticks.interval > 0.0 ? exact_number(settings.ticks.interval) : "auto";
  options.surface = name_of(surface.hold);
  options.depth = kMillimetres * surface.depth;
  options.snap = kMillimetres * surface.snap_distance;
  options.along_streamline = surface.along_streamline;
  options.isovalues.clear();
  for (int i = 0; i < surface.isovalues.count; ++i) {
    (options.isovalues += i > 0 ? "," : "") += exact_number(surface.isovalues.value[as_size(i)]);
  }
  options.field_force = settings.force_field.strength;
  options.field_damping = settings.force_field.damping;
  options.density_curve = settings.force_field.density.text();
  options.anisotropy_curve = settings.anisotropy.tau.text(1.0 / kMillimetres);
  options.noise_texture = texture_text(settings.texture);
  options.fixtures.list = choice.fixtures;
  keep_fixtures(settings, options.fixtures);
  options.linear = linear_text(settings.linear);
  options.grid = grid_text(settings.grid_axis);
  options.planes = plane_text(settings.plane_widget);
  options.stroke = name_of(choice.stroke);
  options.show_surfaces = choice.show_surface;
  options.show_path = choice.show_path;
  options.stream_balls = choice.show_balls;
  options.fade_lines = choice.fade_rest;
  options.local_lines = name_of(choice.local);
}

ChainSettings touch_settings(const TouchOptions& options, const VectorField* field,
                             const Workspace& workspace) {
  ChainSettings settings = touch_settings(options);
  if (field != nullptr && wants_ticks(options) && settings.ticks.interval == 0.0) {
    settings.ticks.interval = default_tick_interval(*field, workspace);
  }
  return settings;
}

void check_replay_options(const Document& options) {
  if (options.hand.replay.empty()) return;
  for (const std::string& name : options.given) {
    const Setting* row = find_setting(name, options.input.kind);
    if (row != nullptr && row->recorded)
      throw usage_error("--" + name + " is part of the recording; leave it out with --replay");
  }
  if (options.hand.device != "mouse") throw usage_error("give either --replay or --device, not both");
}

std::vector<std::string> changed_since(const RecordingHeader& header, const Document& options,
                                       Progress& progress) {
  std::vector<SessionInput> open;
  for (const auto& file : options.input.files) open.push_back(describe_input(file, false, &progress));
  if (options.input.solution) open.push_back(describe_input(*options.input.solution, true, &progress));
  std::vector<std::string> changed;
  for (std::size_t i = 0; i < std::max(open.size(), header.inputs.size()); ++i) {
    if (i >= open.size()) {
      changed.push_back("it was recorded on " + header.inputs[i].file + ", which is not open");
    } else if (i >= header.inputs.size()) {
      changed.push_back(open[i].file.string() + " was not open when it was recorded");
    } else if (open[i].bytes != header.inputs[i].bytes ||
               (!header.inputs[i].sha256.empty() && open[i].sha256 != header.inputs[i].sha256)) {
      changed.push_back(open[i].file.string() + " is not the file that was recorded as " +
                        header.inputs[i].file);
    }
  }
  for (const auto& [key, value] : header.values) {
    if (key == "example" && value != options.input.example) {
      changed.push_back("it was recorded on example " + value);
    }
  }
  return changed;
}

DeviceLimits touch_limits(const TouchOptions& options) {
  DeviceLimits limits;
  limits.force_cap = options.force_cap;
  limits.slew_cap = options.slew_cap;
  if (!limits.valid()) throw usage_error("--force-cap and --slew-cap must be above zero");
  return limits;
}

}  // namespace palpate
