#include "common/render/budget/frame_quality.h"

#include <cstddef>
#include <span>
#include <vector>

namespace palpate {
namespace {

// Each of `qualities` with all of `shares`, too.
void add_shares(std::vector<FrameQuality>& qualities, double FrameQuality::*what,
                std::span<const double> shares) {
  const std::size_t count = qualities.size();
  for (const double share : shares) {
    for (std::size_t i = 0; i < count; ++i) {
      qualities.push_back(qualities[i]);
      qualities.back().*what = share;
    }
  }
}

}  // namespace

std::vector<FrameQuality> frame_qualities(bool volume, bool lenses) {
  std::vector<FrameQuality> qualities{{}};
  if (!volume) add_shares(qualities, &FrameQuality::detail, kDetailShares);
  if (volume) add_shares(qualities, &FrameQuality::context, kContextShares);
  if (volume && lenses) {
    add_shares(qualities, &FrameQuality::viewport, kViewportShares);
    add_shares(qualities, &FrameQuality::focus, kFocusShares);
  }
  add_shares(qualities, &FrameQuality::resolution, kResolutionShares);
  if (!volume) std::erase_if(qualities, [](const FrameQuality& q) { return q.resolution < kLeastOfLines; });
  return qualities;
}

SceneView with_quality(SceneView view, const FrameQuality& quality) {
  if (!view.volume) return view;
  view.volume->samples_per_voxel *= quality.context;
  view.volume->context.viewport *= quality.viewport;
  for (Lens& lens : view.volume->lenses) lens.samples_per_voxel *= quality.focus;
  return view;
}

}  // namespace palpate
