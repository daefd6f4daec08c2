#include "common/haptics/scalar_frame.h"

#include <cmath>
#include <utility>

#include "common/haptics/fade.h"
#include "common/haptics/frame_along.h"
#include "common/haptics/measure.h"

namespace palpate {

ScalarFrame::ScalarFrame(std::shared_ptr<const ScalarField> field, const Workspace& workspace,
                         Outward outward, Tangents tangents, double certain_part)
    : field_(std::move(field)),
      workspace_(workspace),
      outward_(outward),
      tangents_(tangents),
      certain_steepness_(certain_part * (field_->highest() - field_->lowest()) / field_->diagonal()),
      spacing_(stencil_spacing(*field_)) {}

FrameSample ScalarFrame::at(const Vec3& x, const Mat3& last) noexcept {
  const Vec3 x_data = workspace_.data_from_workspace(x);
  Jet3 jet;
  FrameSample frame{.axes = last, .certainty = 0.0, .split = 0.0};
  if (tangents_ == Tangents::kPrincipal) {
    frame.status = difference_jet(*field_, x_data, spacing_, hint_, jet);
  } else {
    const VectorSample gradient = difference_gradient(*field_, x_data, spacing_, hint_);
    frame.status = gradient.status;
    jet.gradient = gradient.value;
  }
  if (frame.status != SampleStatus::kOk) return frame;
  const Vec3 g = jet.gradient / certain_steepness_;
  const double steepness = glm::length(g);
  constexpr double kLeast = 0x1p-40;  // below, a direction is rounding
  if (!(steepness > kLeast)) return frame;
  const Vec3 n = g / steepness;
  frame.axes = carried_axes(last, outward_ == Outward::kRising ? n : -n);
  frame.certainty = fade(steepness);
  if (tangents_ == Tangents::kOpen) return frame;

  // (1) in a basis that rests on n alone, so that the same place gives the same bits; one Jacobi rotation.
  const Mat3 basis = frame_along(frame.axes[0]);
  const Vec3 &t = basis[1], &u = basis[2];
  const Mat3 h = jet.hessian / certain_steepness_;
  const double scale = -1.0 / (steepness * workspace_.scale());  // to 1/m
  const double tt = scale * glm::dot(t, h * t), tu = scale * glm::dot(t, h * u);
  const double uu = scale * glm::dot(u, h * u);
  const double half_difference = 0.5 * (tt - uu);
  const double difference = 2.0 * std::hypot(half_difference, tu);  // k_1 - k_2
  if (!(difference > kLeast * kCertainCurvature)) return frame;
  const double angle = 0.5 * std::atan2(tu, half_difference);  // of k_1's direction from t, in (-pi/2, pi/2]
  Vec3 first = std::cos(angle) * t + std::sin(angle) * u;
  if (glm::dot(first, last[1]) < 0.0) first = -first;
  frame.axes[1] = first;
  frame.axes[2] = glm::cross(frame.axes[0], first);
  frame.split = fade(difference / kCertainCurvature);
  return frame;
}

}  // namespace palpate
