#include "common/haptics/velocity_estimate.h"

#include <algorithm>

namespace palpate {

void VelocityEstimate::reset() noexcept {
  count_ = 0;
  window_ = 0;
  velocity_ = Vec3{0.0};
}

const Vec3& VelocityEstimate::update(double time, const Vec3& position) noexcept {
  if (count_ > 0 && !(time > sample(0).time)) return velocity_;
  newest_ = (newest_ + 1) % kWindow;
  samples_[newest_] = {time, position};
  count_ = std::min(count_ + 1, kWindow);
  velocity_ = Vec3{0.0};
  window_ = 0;
  for (std::size_t n = 1; n < count_; ++n) {
    const Vec3 slope = (position - sample(n).position) / (time - sample(n).time);
    if (!is_finite(slope) || !fits(slope, n)) break;
    velocity_ = slope;
    window_ = n;
  }
  return velocity_;
}

/// Whether all positions inside the window lie along the line. A window of one interval has none.
bool VelocityEstimate::fits(const Vec3& velocity, std::size_t window) const noexcept {
  const Sample& now = sample(0);
  for (std::size_t i = 1; i < window; ++i) {
    const Sample& then = sample(i);
    const Vec3 on_line = now.position - velocity * (now.time - then.time);
    if (!(glm::distance(then.position, on_line) <= noise_)) return false;
  }
  return true;
}

}  // namespace palpate
