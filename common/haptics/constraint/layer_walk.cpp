#include "common/haptics/constraint/layer_walk.h"

#include <cmath>
#include <utility>

#include "common/haptics/fade.h"

namespace palpate {

LayerWalk::LayerWalk(std::shared_ptr<const LayeredHeart> heart, const LayerConstraint& layer)
    : heart_(std::move(heart)), layer_(layer), search_(make_isosurface_search(heart_->heart().layer)) {}

bool LayerWalk::follow(const SurfacePoint& place, LinkUpdate& link) noexcept {
  if (surface().held_by() < 0) {
    caught_ = false;
    return false;
  }
  if (!caught_ || place.level != point_.level) {
    // Another layer: its own proxy has jumped, and this one goes with it.
    link.jumped = true;
    point_ = place;
    fit_ = {};
    caught_ = true;
  }
  return true;
}

bool LayerWalk::move(const Vec3& way, SearchWork& work) noexcept {
  fit_ = search_->settle(point_.position + way, point_, work);
  return fit_.end == SurfaceEnd::kClosest;
}

FibreSample LayerWalk::sample() noexcept {
  hint_.cell = point_.cell;
  return heart_->sample(point_.position, hint_);
}

void LayerWalk::describe(LinkUpdate& link) const noexcept {
  const Workspace& workspace = surface().workspace();
  link.proxy = workspace.workspace_from_local(point_.position);
  const double slope = glm::length(fit_.gradient);
  if (slope > 0.0) link.residual = std::abs(fit_.error) / slope * workspace.local_scale();
}

double fibre_certainty(double gap) noexcept {
  constexpr double kFullGap = 0.1;
  return fade(gap / kFullGap);
}

}  // namespace palpate
