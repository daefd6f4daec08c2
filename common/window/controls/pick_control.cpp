#include "common/window/controls/pick_control.h"

#include <utility>
#include <vector>

#include "common/base/index.h"
#include "common/haptics/widget/plane_widget.h"

namespace palpate {
namespace {

/// A ray hits lines that are this near to it [m].
constexpr double kRayRadius = 0.003;

ConvexShape::HalfSpace moved_plane(const ConvexShape::HalfSpace& plane, const Rigid& motion) {
  const Vec3 n = motion.rotation * plane.outward;
  return {n, glm::dot(n, motion * (plane.offset * plane.outward))};
}

PlanePose moved_pose(const PlanePose& pose, const Rigid& motion) {
  const Quat turn =
      glm::normalize(motion.rotation * Quat{pose.turn.w, pose.turn.x, pose.turn.y, pose.turn.z});
  return {motion * pose.center, {turn.x, turn.y, turn.z, turn.w}};
}

}  // namespace

std::optional<PickingHand> picking_hand(ProbeSession& touch, const Camera& seeing) {
  const HandsIntent& intent = touch.hand().intent();
  const Vec3 viewer = eye(seeing);
  PickingHand hand;
  Ray ray;
  if (intent.pointing && intent.stylus) {
    hand = {.pose = *intent.stylus, .presses = intent.acts, .can_move = true, .carried = intent.carried};
    ray = *intent.pointing;
  } else if (const auto tip = touch.hand().device_tip(seeing); tip && *tip != viewer) {
    hand.pose.translation = *tip;
    hand.presses = touch.hand().device_presses();
    ray = {hand.pose.translation, glm::normalize(hand.pose.translation - viewer)};
  } else {
    return std::nullopt;
  }
  const InteractionGeometry& interaction = touch.hand().interaction();
  hand.beam =
      interaction.through_aperture && ray.origin != viewer
          ? beam_of(Aperture{viewer, ray.origin, interaction.aperture / touch.data().workspace().scale()})
          : beam_of(ray, kRayRadius / touch.data().workspace().scale());
  return hand;
}

std::string PickControl::take_hold(const PickingHand& hand, const SceneView& view, ProbeSession& touch) {
  held_ = Held{.picked = *picked_, .grip = hand.pose};
  const std::size_t i = picked_->index;
  switch (picked_->kind) {
    case PickKind::kLine: {
      held_.reset();
      const auto kept = touch.trail().keep_picked((*view.lines)[i]);
      if (hand.can_move) touch.hand().move(picked_->place);
      return kept == ProbeTrail::Keeping::kKept ? "kept " + name_of(*picked_)
                                                : name_of(*picked_) + " is kept";
    }
    case PickKind::kLens:
      held_->shape = view.volume->lenses[i].shape;
      lens_ = i;
      break;
    case PickKind::kHandle:
    case PickKind::kPlane:
      if (touch.planes() && i < as_size(touch.planes()->poses.count)) {
        held_->poses = touch.planes()->poses;
      } else {
        held_->kept = view.volume->cuts[i].kept;
      }
      break;
  }
  return name_of(*picked_) + " goes with the hand";
}

void PickControl::move_held(const PickingHand& hand, SceneView& view, ProbeSession& touch) const {
  const Rigid motion = hand.pose * held_->grip.inverse();
  const std::size_t i = held_->picked.index;
  if (held_->picked.kind == PickKind::kLens) {
    if (!view.volume || i >= view.volume->lenses.size()) return;
    const Vec3 middle = center_of(held_->shape, held_->picked.place);
    view.volume->lenses[i].shape = moved(held_->shape, motion * middle - middle);
  } else if (held_->poses) {
    PlanePoses poses = *held_->poses;
    poses.pose[i] = moved_pose(poses.pose[i], motion);
    touch.put_planes(poses);
  } else if (view.volume && i < view.volume->cuts.size()) {
    view.volume->cuts[i].kept = moved_plane(held_->kept, motion);
  }
}

void PickControl::carry_lens(const PickingHand& hand, SceneView& view, const ProbeSession& touch) {
  const bool can = hand.carried && lens_ && !held_ && !touch.planes() && view.volume &&
                   *lens_ < view.volume->lenses.size();
  if (!can) {
    carried_.reset();
    return;
  }
  Lens& lens = view.volume->lenses[*lens_];
  if (!carried_) carried_ = lens.shape;
  const Vec3 middle = center_of(*carried_, view.bounds.center());
  lens.shape = moved(*carried_, *hand.carried * middle - middle);
}

std::optional<std::string> PickControl::follow(const std::optional<PickingHand>& hand, SceneView& view,
                                               ProbeSession& touch) {
  if (!hand) {
    picked_.reset();
    held_.reset();
    carried_.reset();
    pressed_ = false;
    return std::nullopt;
  }
  const bool begins = hand->presses && !std::exchange(pressed_, hand->presses);
  pressed_ = hand->presses;
  if (held_ && hand->presses) {
    move_held(*hand, view, touch);
    picked_->place = hand->pose * held_->grip.inverse() * held_->picked.place;
    return std::nullopt;
  }
  held_.reset();
  carry_lens(*hand, view, touch);
  std::vector<PickBall> handles;
  if (touch.planes()) {
    for (int i = 0; i < touch.planes()->poses.count; ++i)
      handles.push_back({touch.planes()->poses.pose[as_size(i)].center, touch.sphere_radius()});
  }
  std::vector<ConvexShape::HalfSpace> planes;
  picked_ = pick(scene_of(view, handles, planes), hand->beam);
  if (!begins || !picked_) return std::nullopt;
  return take_hold(*hand, view, touch);
}

}  // namespace palpate
