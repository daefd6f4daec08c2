/// How both eyes see a picture, from options.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "common/render/scene_view.h"
#include "common/scene/options.h"

namespace palpate {

/// @throws Error (usage) for an unknown mode, which lists the known ones.
[[nodiscard]] StereoView stereo_of(const ViewOptions& options);

/// The options that say it, with what differs from their defaults: for a session.
[[nodiscard]] std::vector<std::pair<const char*, std::string>> stereo_options(const ViewOptions& options);

/// What the eyes of a picture see: mode, separation and disparities, and whether the eyes were brought nearer
/// to each other than was asked for. Empty for one eye.
[[nodiscard]] std::string stereo_text(const SceneView& view);

}  // namespace palpate
