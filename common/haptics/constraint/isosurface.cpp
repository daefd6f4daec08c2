#include "common/haptics/constraint/isosurface.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/base/index.h"
#include "common/haptics/frame_along.h"

namespace palpate {

IsosurfaceConstraint::IsosurfaceConstraint(std::shared_ptr<const ScalarField> field,
                                           const Workspace& workspace, const Isovalues& otherwise)
    : field_(std::move(field)),
      search_(make_isosurface_search(field_)),
      workspace_(workspace),
      otherwise_(otherwise) {}

void IsosurfaceConstraint::apply(const ChainSettings& settings) noexcept {
  const IsosurfaceSettings& wanted = settings.isosurface;
  depth_ = wanted.depth / workspace_.local_scale();
  snap_ = wanted.snap_distance / workspace_.local_scale();
  SurfaceLevels levels;
  const Isovalues& isovalues = wanted.isovalues.count > 0 ? wanted.isovalues : otherwise_;
  levels.count = isovalues.count;
  for (int l = 0; l < levels.count; ++l) {
    const auto i = as_size(l);
    levels.value[i] = isovalues.value[i] * field_->value_scale();
  }
  const bool same = levels.count == levels_.count && levels.value == levels_.value;
  if (!same) path_.side.fill(0);
  if (held_ && levels.count <= index_) {
    held_ = false;
    begun_ = false;
  }
  edited_ = held_ && levels.value[as_size(index_)] != point_.level;
  const bool was_layer = hold_ == IsosurfaceHold::kLayer, layer = wanted.hold == IsosurfaceHold::kLayer;
  if (held_ && layer && !was_layer) begun_ = false;  // the path was not walked meanwhile
  if (held_ && was_layer && !layer)
    free_side_ = fit_.toward > 0.0 ? -1 : 1;  // as if it had come to where it is
  hold_ = wanted.hold;
  levels_ = levels;
}

void IsosurfaceConstraint::reset() noexcept {
  held_ = false;
  begun_ = false;
  edited_ = false;
  contact_ = {};
}

/// Whether a probe that comes from that side is held.
bool IsosurfaceConstraint::stops(std::int8_t from) const noexcept {
  if (hold_ == IsosurfaceHold::kBelow) return from < 0;
  if (hold_ == IsosurfaceHold::kAbove) return from > 0;
  return true;
}

void IsosurfaceConstraint::update(const Vec3& probe, const UpdateBudget& budget, LinkUpdate& link) noexcept {
  const Vec3 x = workspace_.local_from_workspace(probe);
  SearchWork work{.limit = budget.iterations};
  const int before = held_by();
  link.proxy = probe;
  if (edited_) move_to_edited(work, link);
  // A probe that one surface lets go may be caught by the next in the same step, but not without end.
  constexpr int kMostSurfaces = 2 * Isovalues::kMax;
  for (int turn = 0; turn == 0 || (turn < kMostSurfaces && work.take()); ++turn) {
    if (!held_ && !roam(x, work, link)) {
      const bool behind = path_.at != x;  // the work did not reach
      const bool known = levels_.count == 0 || path_.side[0] != 0;
      const HoldState now = behind ? HoldState::kFellBack : known ? HoldState::kFree : HoldState::kOutside;
      link.state = std::max(link.state, now);
      break;
    }
    if (follow(x, work, link)) {
      describe(x, link);
      break;
    }
  }
  link.iterations = work.used;
  link.crossed = held_by() != before || link.state == HoldState::kReleased;
  contact_ = {.touches = held_, .depth = glm::distance(probe, link.proxy), .normal = link.frame[0]};
}

/// Walks the path of a free probe. True where a surface catches it.
bool IsosurfaceConstraint::roam(const Vec3& x, SearchWork& work, LinkUpdate& link) noexcept {
  fit_ = {};
  if (!begun_) path_ = {.at = x};
  begun_ = true;
  for (;;) {
    const int index = search_->advance(path_, x, levels_, work);
    if (index < 0) break;
    const auto from = static_cast<std::int8_t>(-path_.side[as_size(index)]);
    if (stops(from)) {
      hold(index, from, path_);
      return true;
    }
    if (work.spent()) return false;
  }
  return hold_ == IsosurfaceHold::kLayer && snap_ > 0.0 && path_.at == x && snap(x, work, link);
}

/// Catches a probe that is near a layer, as seen along the gradient.
bool IsosurfaceConstraint::snap(const Vec3& x, SearchWork& work, LinkUpdate& link) noexcept {
  CellHint hint{path_.cell};
  Jet3 at;
  if (field_->jet(x, hint, at) != SampleStatus::kOk) return false;
  const double slope = glm::length(at.gradient);
  if (!(slope > 0.0)) return false;
  double nearest = snap_;
  int caught = -1;
  SurfacePath found;
  for (int l = 0; l < levels_.count && !work.spent(); ++l) {
    const double level = levels_.value[as_size(l)];
    const Vec3 towards = at.gradient * ((at.value < level ? 1.0 : -1.0) / slope);
    SurfacePath way{.at = x, .cell = path_.cell};
    if (search_->advance(way, x + nearest * towards, {{level}, 1}, work) < 0) continue;
    caught = l;
    found = way;
    nearest = glm::distance(x, way.at);
  }
  if (caught < 0) return false;
  hold(caught, 0, found);
  link.jumped = true;
  return true;
}

/// The isovalue `index` catches the probe where it is crossed.
void IsosurfaceConstraint::hold(int index, std::int8_t free_side, const SurfacePath& crossing) noexcept {
  held_ = true;
  edited_ = false;
  index_ = index;
  free_side_ = free_side;
  point_ = {crossing.at, levels_.value[as_size(index)], crossing.cell};
}

/// Frees the probe; its path goes on from the proxy, on that side of the surface.
void IsosurfaceConstraint::let_go(std::int8_t side) noexcept {
  held_ = false;
  path_ = {.at = point_.position, .cell = point_.cell};
  path_.side[as_size(index_)] = side;
}

/// Moves the proxy after `x`. False where the surface lets the probe go.
bool IsosurfaceConstraint::follow(const Vec3& x, SearchWork& work, LinkUpdate& link) noexcept {
  const bool layer = hold_ == IsosurfaceHold::kLayer;
  if (layer) change_layers(x, work, link);
  fit_ = search_->settle(x, point_, work);
  const double stretch = glm::distance(x, point_.position);
  if (!layer && (stretch == 0.0 || fit_.toward * free_side_ > 0.0)) {
    let_go(free_side_);
    return false;
  }
  if (stretch > depth_) {
    link.state = HoldState::kReleased;
    link.jumped = true;
    if (layer) {
      held_ = false;  // its path has been walked all along
    } else {
      let_go(static_cast<std::int8_t>(-free_side_));
    }
    return false;
  }
  return true;
}

/// A probe on a layer that crosses another one goes over to it.
void IsosurfaceConstraint::change_layers(const Vec3& x, SearchWork& work, LinkUpdate& link) noexcept {
  if (!begun_) path_ = {.at = x};
  begun_ = true;
  while (path_.at != x && !work.spent()) {
    const int index = search_->advance(path_, x, levels_, work);
    if (index < 0) break;
    if (index == index_) continue;
    hold(index, 0, path_);
    link.jumped = true;
  }
}

/// The isovalue that holds the probe was edited: to its new surface along the gradient, as far as the depth.
void IsosurfaceConstraint::move_to_edited(SearchWork& work, LinkUpdate& link) noexcept {
  edited_ = false;
  if (!held_) return;
  const double level = levels_.value[as_size(index_)];
  const double slope = glm::length(fit_.gradient);
  link.jumped = true;
  SurfacePath way{.at = point_.position, .cell = point_.cell};
  const Vec3 towards = fit_.gradient * ((level > point_.level ? 1.0 : -1.0) / slope);
  if (slope > 0.0 && search_->advance(way, way.at + depth_ * towards, {{level}, 1}, work) >= 0) {
    point_ = {way.at, level, way.cell};
    return;
  }
  held_ = false;
  begun_ = false;
}

void IsosurfaceConstraint::describe(const Vec3& x, LinkUpdate& link) const noexcept {
  const HoldState now = fit_.end == SurfaceEnd::kClosest ? HoldState::kHeld : HoldState::kFellBack;
  link.state = std::max(link.state, now);
  // Not away from the probe by the rounding of a change of frame.
  if (point_.position != x) link.proxy = workspace_.workspace_from_local(point_.position);
  const auto turn = [this](const Mat3& m) {
    return Mat3{workspace_.turned(m[0]), workspace_.turned(m[1]), workspace_.turned(m[2])};
  };
  link.jacobian = turn(glm::transpose(turn(fit_.jacobian)));  // R J R^T, J symmetric
  const double slope = glm::length(fit_.gradient);
  if (!(slope > 0.0)) return;
  link.frame = frame_along(workspace_.turned(fit_.gradient / slope));
  link.residual = std::abs(fit_.error) / slope * workspace_.local_scale();
}

}  // namespace palpate
