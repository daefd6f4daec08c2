#include "common/render/budget/quality_errors.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "common/base/index.h"

namespace palpate {
namespace {

void add_square(PartError& sum, const PartError& error) noexcept {
  sum.focus += error.focus * error.focus;
  sum.context += error.context * error.context;
}

// Of a share; nothing where that is 1.
template <std::size_t N>
std::optional<std::size_t> place_of(const std::array<double, N>& shares, double share) noexcept {
  const auto* const found = std::find(shares.begin(), shares.end(), share);
  if (found == shares.end()) return std::nullopt;
  return as_size(found - shares.begin());
}

}  // namespace

PartError QualityErrors::of(const FrameQuality& quality) const noexcept {
  PartError sum{asked.focus * asked.focus, asked.context * asked.context};
  if (const auto k = place_of(kContextShares, quality.context)) add_square(sum, context[*k]);
  if (const auto k = place_of(kFocusShares, quality.focus)) add_square(sum, focus[*k]);
  const auto coarser = place_of(kViewportShares, quality.viewport);
  const auto smaller = place_of(kResolutionShares, quality.resolution);
  if (coarser && smaller && pixels) {
    add_square(sum, (*pixels)[*coarser][*smaller]);
  } else {
    if (coarser) add_square(sum, viewport[*coarser]);
    if (smaller) add_square(sum, resolution[*smaller]);
  }
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
      .focus_share = 0.04};
  return kUsual;
}

}  // namespace palpate
