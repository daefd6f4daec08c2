/// What the user can choose about touch, and how the command line says it.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/hand/drawn/drawn_tract.h"
#include "common/haptics/chain_settings.h"
#include "common/render/probe_view.h"

namespace palpate {

/// What the user can choose about touch, as panels edit it.
struct TouchChoice {
  std::size_t mode = 0;  ///< index into the modes
  ChainSettings settings;
  std::vector<std::string> fixtures;  ///< FixtureSpec::list
  bool ticks = false;  ///< tick marks: at settings.ticks.interval, or default_tick_interval() where that is 0
  bool show_balls = true;
  bool show_path = true;
  std::optional<bool> show_surface;       ///< isosurfaces and layers that are felt; absent: all but layers
  StrokeUse stroke = StrokeUse::kAppend;  ///< of tracts that are drawn by hand
  bool fade_rest = true;                  ///< the scene's own lines step back while a hand is on the probe
  SeedShape local = SeedShape::kNone;

  bool operator==(const TouchChoice&) const = default;
};

/// "append", as `--stroke` says it.
[[nodiscard]] std::string_view name_of(StrokeUse use) noexcept;
/// @throws Error (usage) that lists the known ones.
[[nodiscard]] StrokeUse stroke_use_from_name(std::string_view name);

}  // namespace palpate
