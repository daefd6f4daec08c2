/// Settings of a chain as text, as recordings carry them:
///
///   stiffness=200 streamline.release=0.01 streamline.speed_force=0 ticks.interval=0 …
///
/// The names of ChainSettings::each(), SI units, a space between. Every value reads back to the same bits.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "common/haptics/chain_settings.h"

namespace palpate {

[[nodiscard]] std::string settings_text(const ChainSettings& settings);

/// Reads what settings_text() wrote: every name once, in any order, and values that a chain can use.
/// @return what is wrong, in a few words; nothing where `settings` has been read.
[[nodiscard]] std::optional<std::string> read_settings(std::string_view text, ChainSettings& settings);

}  // namespace palpate
