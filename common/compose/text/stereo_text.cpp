#include "common/compose/text/stereo_text.h"

#include <algorithm>
#include <cmath>

#include "common/base/error.h"
#include "common/base/index.h"
#include "common/base/text.h"
#include "common/math/quaternion.h"

namespace palpate {

StereoView stereo_of(const ViewOptions& options) {
  const auto* const found = std::find(kStereoModeNames.begin(), kStereoModeNames.end(), options.stereo);
  if (found == kStereoModeNames.end()) {
    std::string known;
    for (const std::string_view name : kStereoModeNames)
      known += (known.empty() ? "" : ", ") + std::string(name);
    throw usage_error("--stereo " + options.stereo + ": no such mode; there are " + known);
  }
  return {.mode = static_cast<StereoMode>(found - kStereoModeNames.begin()),
          .separation = options.eye_separation / options.eye_distance,
          .most_disparity = options.disparity_limit * kDegree,
          .swapped = options.swap_eyes};
}

std::string stereo_text(const SceneView& view) {
  if (!has_two_eyes(view)) return {};
  const StereoEyes eyes = stereo_eyes(view.camera, view.stereo, view.bounds);
  const auto degrees = [](double angle) {
    return short_number(std::round(1e3 * angle / kDegree) / 1e3) + " degrees";
  };
  std::string text = "stereo " + std::string(kStereoModeNames[as_size(view.stereo.mode)]) + ": disparity " +
                     degrees(eyes.near_disparity) + " at the nearest, " + degrees(eyes.far_disparity) +
                     " at the farthest point";
  if (eyes.limited < 1.0)
    text += "; eyes brought to " + short_number(std::round(100.0 * eyes.limited)) +
            " % of their separation, as --disparity-limit demands";
  return text + "\n";
}

}  // namespace palpate
