#include "common/haptics/constraint/mesh_surface.h"

#include <algorithm>
#include <utility>

#include "common/haptics/frame_along.h"

namespace palpate {
namespace {

constexpr double kGap = 1e-7;     // [m] a ten-thousandth of a millimetre: nothing that is felt
constexpr int kMostVisits = 512;  // of boxes and triangles along the ways of a free probe, in one update
constexpr int kTrianglesAnIteration = 2;  // that are walked over
constexpr int kWallsInARow = 4;           // that a probe goes over to in one update
constexpr double kAroundTheRim = 1e-6;    // part of the stretch that points off the surface there

}  // namespace

MeshConstraint::MeshConstraint(std::shared_ptr<const SurfaceMesh> mesh, const Workspace& workspace)
    : mesh_(std::move(mesh)), workspace_(workspace), gap_(kGap / workspace.scale()) {}

void MeshConstraint::reset() noexcept {
  begun_ = held_ = false;
  contact_ = {};
}

void MeshConstraint::update(const Vec3& probe, const UpdateBudget& budget, LinkUpdate& link) noexcept {
  const Vec3 x = workspace_.data_from_workspace(probe);
  link.proxy = probe;
  contact_ = {};
  if (!begun_) {
    begun_ = true;
    from_ = x;
  }
  const bool held_before = held_;
  bool slipped = false;
  Work work{.triangles = kTrianglesAnIteration * budget.iterations, .visits = kMostVisits};
  for (int walls = 0;; ++walls) {
    if (held_) {
      const Hold now = follow(x, work, link);
      link.iterations = (work.looked + kTrianglesAnIteration - 1) / kTrianglesAnIteration;
      if (now == Hold::kHeld) break;
      held_ = false;
      slipped = slipped || now == Hold::kSlipped;
      if (now == Hold::kRests) {
        link.crossed = held_before;
        return;
      }
    }
    if (!meet(x, work, link)) {
      link.crossed = held_before;
      link.jumped = slipped;
      if (slipped) link.state = HoldState::kReleased;
      return;
    }
    if (walls == kWallsInARow) {
      link.state = HoldState::kFellBack;
      break;
    }
  }
  link.crossed = !held_before;
  describe(probe, link);
}

bool MeshConstraint::meet(const Vec3& x, Work& work, LinkUpdate& link) noexcept {
  const Vec3 way = x - from_;
  const double length = glm::length(way);
  if (!(length > 0.0)) return false;
  // What comes as near as the gap has met it: so a free probe is never on the surface itself.
  const BoxTree::Found found = mesh_->first_met(from_, x + (gap_ / length) * way, work.visits);
  work.visits -= found.visits;
  if (!found.complete) link.state = HoldState::kFellBack;
  if (found.thing == BoxTree::kNone || found.value > found.unseen) {
    // What could not be looked at is a matter of the next update: there may be a surface on it.
    const double seen = std::max(0.0, found.unseen * (length + gap_) - gap_);
    from_ = found.complete ? x : from_ + (seen / length) * way;
    return false;
  }
  place_ = mesh_->nearest_on(found.thing, from_ + found.value * (1.0 + gap_ / length) * way);
  SurfacePlace face = place_;
  face.part = SurfacePlace::kFace;
  side_ = glm::dot(way, mesh_->normal(face)) < 0.0 ? 1.0 : -1.0;
  held_ = true;
  return true;
}

MeshConstraint::Hold MeshConstraint::follow(const Vec3& x, Work& work, LinkUpdate& link) noexcept {
  if (work.looked >= work.triangles || !mesh_->walk(x, place_, work.triangles, work.looked)) {
    link.state = HoldState::kFellBack;
    return Hold::kHeld;
  }
  const Vec3 up = side_ * mesh_->normal(place_);
  const Vec3 stretch = x - place_.point;
  const double off = glm::dot(stretch, up);
  const Vec3 aside = stretch - off * up;
  const double beside = glm::length(aside);
  const bool slips = off < 0.0 && mesh_->at_rim(place_) && beside > kAroundTheRim * glm::length(stretch);
  if (off < 0.0 && !slips) {
    link.state = HoldState::kHeld;
    return Hold::kHeld;
  }
  // The way of the probe goes on from where the proxy has slid to, just off the surface.
  from_ = place_.point + gap_ * up;
  if (slips) from_ += (gap_ / beside) * aside;
  if (slips) return Hold::kSlipped;
  return off <= gap_ ? Hold::kRests : Hold::kLeft;
}

void MeshConstraint::describe(const Vec3& x, LinkUpdate& link) noexcept {
  link.proxy = workspace_.workspace_from_data(place_.point);
  Vec3 n = mesh_->normal(place_);
  if (n == Vec3{0.0}) n = {1.0, 0.0, 0.0};
  link.frame = frame_along(n);
  if (place_.part == SurfacePlace::kFace) {
    link.jacobian = Mat3{1.0} - glm::outerProduct(n, n);
  } else if (place_.part < SurfacePlace::kCorner) {
    const Vec3 along = mesh_->edge(place_);
    link.jacobian = glm::outerProduct(along, along);
  } else {
    link.jacobian = Mat3{0.0};
  }
  contact_ = {.touches = true, .depth = glm::distance(x, link.proxy), .normal = n};
}

}  // namespace palpate
