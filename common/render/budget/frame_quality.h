/// What a frame gives up so that it takes less time.
#pragma once

#include <array>
#include <vector>

#include "common/render/scene_view.h"

namespace palpate {

/// Shares of what was asked for, in (0, 1].
struct FrameQuality {
  double context = 1.0;     ///< of the samples along rays, outside lenses
  double focus = 1.0;       ///< likewise, inside lenses
  double viewport = 1.0;    ///< of the pixels along either edge, outside lenses where there are some
  double resolution = 1.0;  ///< of the pixels along either edge
  double detail = 1.0;      ///< of the segments of lines, where there is no volume

  bool operator==(const FrameQuality&) const = default;
};

/// The shares that frames are drawn with beside 1, falling.
inline constexpr std::array kContextShares{0.5, 0.25};
inline constexpr std::array kFocusShares{0.5};
inline constexpr std::array kViewportShares{0.5, 0.25};
inline constexpr std::array kResolutionShares{0.85, 0.7, 0.5, 0.35, 0.25};
inline constexpr std::array kDetailShares{0.5, 0.25, 0.12, 0.06, 0.03};
/// Lines alone never have fewer pixels: thinner ones would break up.
inline constexpr double kLeastOfLines = 0.5;

/// All that can be given up together of a picture of lines alone, of a volume, or of one with lenses; all
/// that was asked for is the first.
[[nodiscard]] std::vector<FrameQuality> frame_qualities(bool volume, bool lenses);

/// The view drawn with `quality`; resolution and detail are for the renderer.
[[nodiscard]] SceneView with_quality(SceneView view, const FrameQuality& quality);

}  // namespace palpate
