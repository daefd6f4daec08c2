#include "common/render/tract/growing_tracts.h"

#include <algorithm>
#include <optional>

#include "common/base/clock.h"

namespace palpate {
namespace {

// Tracts lie side by side in their thousands, and may be moved further than other lines: by half a pixel at most.
constexpr double kTractTolerance = 2.0;

/// Where a thickness is said and the scene has one slice: what lies within the slab about that.
std::optional<TractSlab> slab_of_scene(const SceneView& view) {
  if (!view.tracts->slab_thickness || !view.tensors) return std::nullopt;
  const TensorView& tensors = *view.tensors;
  if (std::ranges::count(tensors.slices, true) != 1) return std::nullopt;
  const auto axis = static_cast<int>(std::ranges::find(tensors.slices, true) - tensors.slices.begin());
  const Mat3& a = tensors.image->axes;
  return TractSlab{.normal = glm::normalize(glm::cross(a[(axis + 1) % 3], a[(axis + 2) % 3])),
                   .place = tensors.position,
                   .half = 0.5 * *view.tracts->slab_thickness};
}

}  // namespace

bool GrowingTracts::begin(const SceneView& view, const SceneFrame& frame, double milliseconds) {
  drawn_ms_ = unseen_ms_ = 0.0;
  if (!view.tracts) {
    pass_.reset();
    bundle_.reset();
    progress_ = {};
    return false;
  }
  if (!pass_) pass_ = std::make_unique<TractPass>();
  bundle_ = view.tracts->bundle;
  pass_->update(bundle_, frame);
  progress_.begin(pass_->pieces(), std::clamp(view.tracts->opacity, 0.0, 1.0),
                  pass_->pieces_in(milliseconds));
  return true;
}

void GrowingTracts::draw(const SceneView& view, const LineDraw& base, float unit, double milliseconds,
                         const std::function<bool()>& stop) {
  drawn_ms_ = 0.0;
  if (progress_.next() == progress_.goal()) return;
  const Stopwatch watch;
  const TractDraw how{.width = static_cast<float>(view.tracts->width) * unit,
                      .fading = view.tracts->depth_cue ? 1.0F : 0.0F,
                      .dimming = static_cast<float>(std::clamp(view.style.dimming, 0.0, 1.0)),
                      .opacity = static_cast<float>(progress_.opacity()),
                      .tolerance = kTractTolerance * base.tolerance,
                      .slab = view.tracts->slab ? view.tracts->slab : slab_of_scene(view)};
  progress_.drawn(pass_->draw(how, progress_.next(), progress_.goal(), milliseconds, stop));
  drawn_ms_ = 1e3 * watch.seconds();
}

bool GrowingTracts::show(bool first, double over) noexcept {
  unseen_ms_ += drawn_ms_;
  const bool due =
      progress_.worth_showing() && unseen_ms_ > 0.0 && (unseen_ms_ >= over || progress_.complete());
  if (!first && !due) return false;
  unseen_ms_ = 0.0;
  return true;
}

TractShare GrowingTracts::share() const noexcept {
  if (!pass_) return {};
  const std::size_t pieces = progress_.shown();
  return {.drawn = pieces > 0 ? bundle_->pieces[pieces - 1].second : 0,
          .all = bundle_->order.size(),
          .milliseconds = drawn_ms_};
}

}  // namespace palpate
