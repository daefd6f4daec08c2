#include "common/device/pose_prediction.h"

#include <algorithm>

namespace palpate {

void PosePrediction::take(double time, const TrackerPose& pose) noexcept {
  if (count_ > 0 && !(time > at(0).time)) return;
  ring_[next_] = {time, pose};
  next_ = (next_ + 1) % kMost;
  count_ = std::min(count_ + 1, kMost);
  fit();
}

void PosePrediction::fit() noexcept {
  // Times of samples at equal distances differ in their last bits.
  constexpr double kSlack = 1e-9;
  const Sample& newest = at(0);
  std::size_t n = 1;
  while (n < count_ && newest.time - at(n).time <= window_ * (1.0 + kSlack)) ++n;

  double mean = 0.0;
  for (std::size_t i = 0; i < n; ++i) mean += (at(i).time - newest.time) / static_cast<double>(n);
  double spread = 0.0;
  Vec3 moved{0.0}, turned{0.0};
  const Quat back = glm::conjugate(newest.pose.orientation);
  for (std::size_t i = 0; i < n; ++i) {
    const double dt = at(i).time - newest.time - mean;
    spread += dt * dt;
    moved += dt * (at(i).pose.position - newest.pose.position);
    turned += dt * rotation_vector(at(i).pose.orientation * back);
  }
  // One sample alone has no velocity.
  velocity_ = spread > 0.0 ? moved / spread : Vec3{0.0};
  turning_ = spread > 0.0 ? turned / spread : Vec3{0.0};
}

TrackerPose PosePrediction::predicted(double time) const noexcept {
  const Sample& newest = at(0);
  const double tau = std::clamp(time - newest.time, 0.0, kFarthest);
  return {newest.pose.position + tau * velocity_, rotation_by(tau * turning_) * newest.pose.orientation};
}

}  // namespace palpate
