/// How both eyes see a picture, from options.
#pragma once

#include <string>

#include "common/render/scene_view.h"
#include "common/scene/document/document.h"

namespace palpate {

/// @throws Error (usage) for an unknown mode, which lists the known ones.
[[nodiscard]] StereoView stereo_of(const ViewOptions& options);

/// What the eyes of a picture see: mode, separation and disparities, and whether the eyes were brought nearer
/// to each other than was asked for. Empty for one eye.
[[nodiscard]] std::string stereo_text(const SceneView& view);

}  // namespace palpate
