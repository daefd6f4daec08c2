#include "common/render/budget/quality_errors.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "common/base/index.h"

namespace palpate {
namespace {

template <std::size_t N>
void add_squares(PartError& sum, const std::array<double, N>& shares, double share,
                 const std::array<PartError, N>& errors) noexcept {
  const auto* const found = std::find(shares.begin(), shares.end(), share);
  if (found == shares.end()) return;
  const PartError& error = errors[as_size(found - shares.begin())];
  sum.focus += error.focus * error.focus;
  sum.context += error.context * error.context;
}

}  // namespace

PartError QualityErrors::of(const FrameQuality& quality) const noexcept {
  PartError sum{asked.focus * asked.focus, asked.context * asked.context};
  add_squares(sum, kContextShares, quality.context, context);
  add_squares(sum, kFocusShares, quality.focus, focus);
  add_squares(sum, kViewportShares, quality.viewport, viewport);
  add_squares(sum, kResolutionShares, quality.resolution, resolution);
  add_squares(sum, kDetailShares, quality.detail, detail);
  return {std::sqrt(sum.focus), std::sqrt(sum.context)};
}

double QualityErrors::rms(const FrameQuality& quality) const noexcept {
  const PartError error = of(quality);
  return std::sqrt(focus_share * error.focus * error.focus +
                   (1.0 - focus_share) * error.context * error.context);
}

double weighed(const PartError& error) noexcept {
  return std::hypot(kFocusWeight * std::max(0.0, error.focus - kUnseen), error.context);
}

const QualityErrors& usual_errors() noexcept {
  static constexpr QualityErrors kUsual{
      .asked = {0.0012, 0.0012},
      .context = {{{0.0044, 0.0017}, {0.0087, 0.0051}}},
      .focus = {{{0.0019, 0.0008}}},
      .viewport = {{{0.0, 0.0160}, {0.0, 0.0196}}},
      .resolution =
          {{{0.0054, 0.0121}, {0.0077, 0.0147}, {0.0127, 0.0187}, {0.0187, 0.0220}, {0.0196, 0.0247}}},
      .detail = {{{0.0, 0.001}, {0.0, 0.002}, {0.0, 0.004}, {0.0, 0.008}, {0.0, 0.0115}}},
      .focus_share = 0.04};
  return kUsual;
}

}  // namespace palpate
