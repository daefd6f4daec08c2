#include "common/hand/technique/immersive_technique.h"

#include <utility>

#include "common/base/index.h"

namespace palpate {

ImmersiveTechnique::ImmersiveTechnique(WorkbenchGeometry workbench, const Vec3& middle, double scale)
    : workbench_(std::move(workbench)), place_(place_of(workbench_.interaction, middle, scale)) {
  intent_.probe = middle;
}

TrackerPose ImmersiveTechnique::corrected(const TrackerPose& reported) const noexcept {
  return workbench_.tracker ? workbench_.tracker->corrected(reported) : reported;
}

Vec3 ImmersiveTechnique::on_surface(const Vec3& q) const noexcept {
  const auto& plane = workbench_.interaction.surface;
  if (!plane) return q;
  const Vec3 n{*plane};
  return q - (glm::dot(n, q) - plane->w) * n;
}

void ImmersiveTechnique::put(const Vec3& probe) noexcept {
  offset_ = probe - tip_;
  intent_.probe = probe;
}

bool ImmersiveTechnique::take(const HandEvent& event, const HandsView& view) noexcept {
  const auto* hands = std::get_if<TrackedHands>(&event);
  if (hands == nullptr) return false;
  if (view.place) place_ = *view.place;
  intent_.acts = hands->acts;
  intent_.pointing.reset();
  intent_.stylus.reset();
  if (hands->stylus) {
    const TrackerPose pose = corrected(*hands->stylus);
    const Vec3 shaft = workbench_.stylus.value_or(Vec3{0.0});
    const Vec3 tip = pose.position + pose.orientation * shaft;
    tip_ = place_(on_surface(tip + workbench_.interaction.tip_offset));
    if (hands->clutch) offset_ = intent_.probe - tip_;
    if (!hands->clutch) intent_.probe = tip_ + offset_;
    const Vec3 along = glm::length(shaft) > 0.0 ? glm::normalize(shaft) : Vec3{0.0, 0.0, -1.0};
    intent_.pointing = Ray{intent_.probe, place_.turn * (pose.orientation * along)};
    intent_.stylus = Rigid{place_.turn * pose.orientation, intent_.probe};
  }
  // A hand that is out of sight for a while goes on with what it holds.
  if (!hands->carries) {
    grip_.reset();
    intent_.carried.reset();
  } else if (hands->other) {
    const TrackerPose pose = corrected(*hands->other);
    const Rigid now{place_.turn * pose.orientation, place_(pose.position)};
    // Where it takes hold nothing has moved, to the bit.
    intent_.carried = grip_ ? now * grip_->inverse() : Rigid{};
    if (!grip_) grip_ = now;
  }
  return true;
}

std::optional<PlanePoses> CarriedPlanes::follow(const HandsIntent& intent,
                                                const std::optional<WidgetNews>& planes) {
  if (!intent.carried || !planes) {
    from_.reset();
    return std::nullopt;
  }
  if (!from_) {
    from_ = planes;
    last_ = planes->poses;
    return std::nullopt;
  }
  PlanePoses poses = from_->poses;
  PlanePose& pose = poses.pose[as_size(from_->current)];
  pose.center = *intent.carried * pose.center;
  const Vec4& turn = pose.turn;
  const Quat turned = glm::normalize(intent.carried->rotation * Quat{turn.w, turn.x, turn.y, turn.z});
  pose.turn = {turned.x, turned.y, turned.z, turned.w};
  if (poses == last_) return std::nullopt;
  last_ = poses;
  return poses;
}

}  // namespace palpate
