#include "common/hand/workbench/head_tracker.h"

#include <algorithm>

namespace palpate {
namespace {

constexpr double kRestingDistance = 0.6;  // [m] before the screen

/// From 0 to 1, at rest at both ends.
double smooth(double part) {
  const double u = std::clamp(part, 0.0, 1.0);
  return u * u * (3.0 - 2.0 * u);
}

Eyes mixed(const Eyes& a, const Eyes& b, double part) {
  return {glm::mix(a[0], b[0], part), glm::mix(a[1], b[1], part)};
}

}  // namespace

HeadTracker::HeadTracker(const WorkbenchGeometry& workbench, const Screen& screen, double separation)
    : correction_(workbench.tracker),
      sensor_latency_(workbench.head.sensor_latency),
      freeze_(workbench.head.freeze),
      glide_(workbench.head.glide),
      predict_(workbench.head.predict),
      prediction_(workbench.head.velocity_window) {
  // Where the file does not say where eyes are on the head, they are beside the sensor, along its x axis.
  const EyesGeometry eyes = workbench.eyes.value_or(EyesGeometry{});
  const Vec3 half{0.5 * separation, 0.0, 0.0};
  on_head_ = {eyes.left.value_or(-half), eyes.right.value_or(half)};
  const Vec3 rest = workbench.head.resting_eye.value_or(center(screen) + kRestingDistance * axes(screen)[2]);
  const Vec3 beside = 0.5 * glm::distance(on_head_[0], on_head_[1]) * axes(screen)[0];
  resting_ = {rest - beside, rest + beside};
  shown_ = from_ = resting_;
}

Eyes HeadTracker::eyes_on(const TrackerPose& pose) const noexcept {
  return {pose.position + pose.orientation * on_head_[0], pose.position + pose.orientation * on_head_[1]};
}

void HeadTracker::follow(PoseSource& source, double now) {
  while (source.next(now, newest_)) {
    if (!newest_.pose) continue;
    // What it did before it was lost says nothing of how fast it is.
    if (!prediction_.empty() && newest_.time - prediction_.newest_time() > kStale) prediction_.forget();
    prediction_.take(newest_.time, correction_ ? correction_->corrected(*newest_.pose) : *newest_.pose);
  }
  present_ = newest_.pose && now - newest_.time < kStale;
}

void HeadTracker::go(State state, double now) noexcept {
  // The first time a head is there at once: nothing was shown before.
  back_ = state == State::kTracked && seen_ ? kReturn : 0.0;
  seen_ = true;
  state_ = state;
  since_ = now;
  from_ = shown_;
}

Eyes HeadTracker::eyes(double now, double seen) {
  if (present_ && state_ != State::kTracked) go(State::kTracked, now);
  if (!present_ && state_ == State::kTracked) go(State::kFrozen, now);
  if (state_ == State::kFrozen && now - since_ >= freeze_) go(State::kGliding, since_ + freeze_);
  if (state_ == State::kGliding && now - since_ >= glide_) go(State::kResting, now);
  switch (state_) {
    case State::kResting:
      shown_ = resting_;
      break;
    case State::kFrozen:
      break;
    case State::kGliding:
      shown_ = mixed(from_, resting_, smooth((now - since_) / glide_));
      break;
    case State::kTracked: {
      const double time = predict_ ? seen + sensor_latency_ : prediction_.newest_time();
      const Eyes there = eyes_on(prediction_.predicted(time));
      const double part = back_ > 0.0 ? smooth((now - since_) / back_) : 1.0;
      shown_ = part < 1.0 ? mixed(from_, there, part) : there;
      break;
    }
  }
  return shown_;
}

const char* HeadTracker::state_name() const noexcept {
  switch (state_) {
    case State::kTracked:
      return "tracked";
    case State::kFrozen:
      return "not seen: where it was";
    case State::kGliding:
      return "not seen: coming to rest";
    case State::kResting:
      break;
  }
  return "at rest";
}

void LatencyMeter::add(double seconds) noexcept {
  ring_[next_] = seconds;
  next_ = (next_ + 1) % kCount;
  count_ = std::min(count_ + 1, kCount);
}

double LatencyMeter::median() const noexcept {
  if (count_ == 0) return 0.0;
  std::array<double, kCount> sorted = ring_;
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(count_ / 2);
  std::nth_element(sorted.begin(), middle, sorted.begin() + static_cast<std::ptrdiff_t>(count_));
  return *middle;
}

}  // namespace palpate
