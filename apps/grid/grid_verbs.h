/// The verbs of volumes.
#pragma once

#include <filesystem>
#include <vector>

#include "common/cli/explorer.h"
#include "common/hand/mode/haptic_mode.h"

namespace palpate {

/// Whether an output is a picture, by its name.
[[nodiscard]] inline bool is_picture(const std::filesystem::path& out) {
  return out.extension() == ".png" || out.extension() == ".PNG";
}

/// A picture. @param modes the program's, the default one first.
[[nodiscard]] Verb volume_render_verb(std::vector<HapticMode> modes, std::vector<UsageExample> examples);
/// A slice, as a picture or an image.
[[nodiscard]] Verb slice_verb(std::vector<UsageExample> examples);
/// Measures what is marked, and writes it as .csv or .vtp.
[[nodiscard]] Verb annotate_verb(std::vector<UsageExample> examples);
/// A part, cut by a box and planes, as a picture or an image.
[[nodiscard]] Verb clip_verb(std::vector<UsageExample> examples);
/// The window.
[[nodiscard]] Verb open_volume_verb(std::vector<UsageExample> examples);

}  // namespace palpate
