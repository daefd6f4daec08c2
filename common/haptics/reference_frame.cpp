#include "common/haptics/reference_frame.h"

#include <utility>

#include "common/haptics/fade.h"
#include "common/haptics/frame_along.h"

namespace palpate {

Mat3 carried_axes(const Mat3& last, const Vec3& e) noexcept {
  if (last[0] == e) return last;
  // The rotation about a x e that takes a to e takes v across a to v - (v . e) / (1 + a . e) (a + e).
  const Vec3& a = last[0];
  const double half = 1.0 + glm::dot(a, e);
  constexpr double kOpposite = 0x1p-20;  // there is no shortest way then
  if (!(half > kOpposite)) return frame_along(e);
  Vec3 second = last[1] - (glm::dot(last[1], e) / half) * (a + e);
  // Rounding would add up over the steps of a day: orthonormal anew each time.
  second = glm::normalize(second - glm::dot(second, e) * e);
  return {e, second, glm::cross(e, second)};
}

FlowFrame::FlowFrame(std::shared_ptr<const VectorField> field, const Workspace& workspace,
                     double certain_part)
    : field_(std::move(field)), workspace_(workspace), certain_speed_(certain_part * field_->max_speed()) {}

FrameSample FlowFrame::at(const Vec3& x, const Mat3& last) noexcept {
  const VectorSample sample = field_->sample(workspace_.data_from_workspace(x), hint_);
  FrameSample frame{.axes = last, .certainty = 0.0, .split = 0.0, .status = sample.status};
  if (sample.status != SampleStatus::kOk) return frame;
  // In units of what is certain: a square neither overflows nor vanishes where it matters.
  const Vec3 v = sample.value / certain_speed_;
  const double speed = glm::length(v);
  constexpr double kLeast = 0x1p-40;  // below, a direction is rounding
  if (!(speed > kLeast)) return frame;
  frame.axes = carried_axes(last, v / speed);
  frame.certainty = fade(speed);
  return frame;
}

}  // namespace palpate
