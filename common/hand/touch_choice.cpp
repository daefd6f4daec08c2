#include "common/hand/touch_choice.h"

#include "common/base/error.h"
#include "common/base/text.h"
#include "common/hand/mode/linear_mode.h"
#include "common/hand/mode/texture_link.h"

namespace palpate {

std::string_view name_of(StrokeUse use) noexcept { return use == StrokeUse::kAppend ? "append" : "replace"; }

StrokeUse stroke_use_from_name(std::string_view name) {
  for (const StrokeUse use : {StrokeUse::kAppend, StrokeUse::kReplace}) {
    if (name == name_of(use)) return use;
  }
  throw usage_error("--stroke " + std::string(name) + ": append, replace are known");
}

std::vector<std::pair<std::string, std::string>> touch_options_of(const TouchChoice& choice,
                                                                  const std::string& mode, bool tensors) {
  constexpr double kMillimetres = 1e3;
  const ChainSettings& settings = choice.settings;
  std::vector<std::pair<std::string, std::string>> options{{"mode", mode},
                                                           {"stiffness", exact_number(settings.stiffness)}};
  if (tensors) {
    options.emplace_back("anisotropy-curve", settings.anisotropy.tau.text(1.0 / kMillimetres));
    options.emplace_back("stroke", name_of(choice.stroke));
    return options;
  }
  const std::vector<std::pair<std::string, std::string>> more{
      {"release", exact_number(kMillimetres * settings.streamline.release_distance)},
      {"drag", exact_number(kMillimetres * settings.drag.threshold)},
      {"tick-stiffness", exact_number(settings.ticks.stiffness)},
      {"speed-force", exact_number(settings.streamline.speed_force)},
      {"field-force", exact_number(settings.force_field.strength)},
      {"field-damping", exact_number(settings.force_field.damping)},
      {"density-curve", settings.force_field.density.text()}};
  options.insert(options.end(), more.begin(), more.end());
  const IsosurfaceSettings& surface = settings.isosurface;
  options.emplace_back("surface", name_of(surface.hold));
  options.emplace_back("depth", exact_number(kMillimetres * surface.depth));
  options.emplace_back("snap", exact_number(kMillimetres * surface.snap_distance));
  std::string isovalues;
  for (int i = 0; i < surface.isovalues.count; ++i) {
    (isovalues += i > 0 ? "," : "") += exact_number(surface.isovalues.value[static_cast<std::size_t>(i)]);
  }
  if (!isovalues.empty()) options.emplace_back("isovalue", isovalues);
  if (surface.along_streamline) options.emplace_back("along-streamline", "true");
  if (settings.texture.by_noise) options.emplace_back("noise-texture", texture_words(settings.texture));
  for (auto& option : linear_options(settings.linear)) options.push_back(std::move(option));
  if (choice.ticks) {
    const double interval = settings.ticks.interval;
    options.emplace_back("ticks", interval > 0.0 ? exact_number(interval) : "auto");
  }
  return options;
}

}  // namespace palpate
