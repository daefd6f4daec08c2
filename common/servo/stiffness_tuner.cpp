#include "common/servo/stiffness_tuner.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/base/check.h"

namespace palpate {
namespace {

constexpr double kRestTime = 0.1;    // [s] without motion that is rest
constexpr double kCalmTime = 0.3;    // [s] without a force after a swing
constexpr double kDrawTime = 10.0;   // [s] in which it must rest at a place
constexpr double kWindow = 1.0;      // [s] over which a motion is compared with itself
constexpr double kDecay = 0.1;       // part by which it must grow narrower from window to window
constexpr double kLongest = 40.0;    // [s] of one knock
constexpr double kDrawSpeed = 0.05;  // [m/s] of the point on its way to a place
constexpr double kFarthest = 0.02;   // [m] from a place at which it counts as reached
constexpr double kFirstKnock = 1.0;  // [N] raised by half until the arm follows
constexpr double kHarder = 1.5;
constexpr double kFollows = 0.5;        // part of a knock that an arm moves whose friction does not rule it
constexpr double kLongestKnock = 2e-3;  // [m] of a soft point
constexpr double kSlack = 5e-3;         // [m] beyond four knocks that is too far
constexpr double kTooFast = 0.3;        // [m/s] from which an arm coasts for a centimetre or two
// Motions narrower than this are none: rounding, and what an encoder hides of any motion.
constexpr double kStillness = 5e-6;                          // [m]
constexpr double kQuanta = 1.5;                              // steps of the encoder
constexpr double kLeastQuantum = 1e-7, kMostQuantum = 1e-4;  // [m] that a change is taken for a step
constexpr int kKnocks = 6;

}  // namespace

bool TuningPlan::valid() const noexcept {
  const auto positive = [](double x) { return std::isfinite(x) && x > 0.0; };
  return !places.empty() && places.size() <= kMostPlaces &&
         std::all_of(places.begin(), places.end(),
                     [](const Vec3& x) { return glm::length(x) <= kFarthest; }) &&
         positive(rate) && positive(least) && positive(most) && least <= most && positive(knock);
}

std::string_view name_of(TuningEnd end) noexcept {
  switch (end) {
    case TuningEnd::kUntried:
      return "untried";
    case TuningEnd::kMost:
      return "most";
    case TuningEnd::kSwings:
      return "swings";
    case TuningEnd::kGrows:
      return "grows";
    case TuningEnd::kRunsAway:
      return "runs_away";
    case TuningEnd::kStuck:
      return "stuck";
    case TuningEnd::kNotReached:
      return "not_reached";
  }
  return "";
}

StiffnessTuner::StiffnessTuner(TuningPlan plan, std::shared_ptr<Channel> news)
    : plan_(std::move(plan)), channel_(std::move(news)), quantum_(kMostQuantum) {
  PALPATE_CHECK(plan_.valid() && channel_ != nullptr);
  force_ = std::min(kFirstKnock, plan_.knock);
  news_.count = plan_.places.size();
  for (std::size_t i = 0; i < news_.count; ++i) news_.results[i].place = plan_.places[i];
}

void StiffnessTuner::reset() noexcept {
  known_ = false;
  if (phase_ == Phase::kDone) return;
  phase_ = Phase::kStart;
  stiffness_ = 0.0;
  halvings_ = 0;
  moved_ = false;
  force_ = std::min(kFirstKnock, plan_.knock);
  result() = {.place = plan_.places[news_.place]};
}

std::uint64_t StiffnessTuner::ticks(double seconds) const noexcept {
  return static_cast<std::uint64_t>(std::ceil(seconds * plan_.rate));
}

bool StiffnessTuner::at_rest() const noexcept { return still_ >= ticks(kRestTime); }

void StiffnessTuner::follow_motion(const Vec3& probe) noexcept {
  if (!known_) {
    known_ = true;
    rest_ = last_ = probe;
    still_ = 0;
  }
  const double step = glm::distance(probe, last_);
  if (step > kLeastQuantum) quantum_ = std::min(quantum_, step);
  leaked_ += 0.5 * stiffness_ * step * step;
  if (glm::distance(probe, rest_) > kStillness + kQuanta * quantum_) {
    rest_ = probe;
    still_ = 0;
  } else {
    ++still_;
  }
}

void StiffnessTuner::update(const Vec3& probe, const UpdateBudget& /*budget*/, LinkUpdate& link) noexcept {
  follow_motion(probe);
  ++elapsed_;
  const Vec3 before = std::exchange(last_, probe);
  switch (phase_) {
    case Phase::kStart:
      begin_draw(plan_.least);
      break;
    case Phase::kDraw:
      draw(probe);
      break;
    case Phase::kKnock:
      watch(probe, glm::distance(probe, before) * plan_.rate);
      break;
    case Phase::kCalm:
      if (elapsed_ < ticks(kCalmTime)) break;
      go_on();
      break;
    case Phase::kDone:
      break;
  }
  news_.stiffness = stiffness_;
  channel_->write(news_);
  link.proxy = stiffness_ > 0.0 ? point_ : probe;
  link.kappa = Vec3{stiffness_ / plan_.most};
  link.jacobian = Mat3{stiffness_ > 0.0 ? 0.0 : 1.0};
  link.state = stiffness_ > 0.0 ? HoldState::kHeld : HoldState::kFree;
}

void StiffnessTuner::draw(const Vec3& probe) noexcept {
  const Vec3 way = plan_.places[news_.place] - point_;
  const double left = glm::length(way), step = kDrawSpeed / plan_.rate;
  if (left > step) {
    point_ += way * (step / left);
    // An arm that the softest point cannot hold on its way is no arm to be made stiffer.
    if (glm::distance(probe, point_) > 2.0 * kFarthest + plan_.knock / plan_.least)
      leave(TuningEnd::kNotReached);
    elapsed_ = 0;
    return;
  }
  point_ += way;
  const bool there = glm::distance(probe, point_) <= kFarthest;
  if (there && at_rest()) {
    stiffness_ = next_;
    knocks_ = 0;
    knock(probe);
  } else if (elapsed_ > ticks(kDrawTime)) {
    leave(result().unstable > 0.0 ? failed_ : there ? TuningEnd::kSwings : TuningEnd::kNotReached);
  }
}

/// Moves the point along one axis after the other, then back.
void StiffnessTuner::knock(const Vec3& probe) noexcept {
  if (knocks_ == 0) {
    leak_ = 0.0;
    follows_ = false;
  }
  length_ = std::min(force_ / stiffness_, kLongestKnock);
  knocked_ = probe;
  point_[knocks_ % 3] += knocks_ < 3 ? length_ : -length_;
  const Vec3 stretch = point_ - probe;
  put_ = 0.5 * stiffness_ * std::max(glm::dot(stretch, stretch), length_ * length_);
  leaked_ = 0.0;
  elapsed_ = 0;
  still_ = 0;
  rest_ = probe;
  range_ = {};
  width_ = 0.0;
  ++knocks_;
  phase_ = Phase::kKnock;
}

void StiffnessTuner::watch(const Vec3& probe, double speed) noexcept {
  const double share = leaked_ / (leaked_ + put_);
  leak_ = std::max(leak_, share);
  moved_ = moved_ || still_ < elapsed_;
  range_.include(probe);
  const double too_far = kSlack + 4.0 * std::min(force_ / stiffness_, kLongestKnock);
  if (glm::distance(probe, point_) > too_far + force_ / stiffness_ || speed > kTooFast) {
    unstable(TuningEnd::kRunsAway);
  } else if (share > kMostLeak) {
    unstable(TuningEnd::kGrows);
  } else if (at_rest()) {
    follows_ = follows_ || glm::distance(probe, knocked_) > kFollows * length_;
    if (knocks_ < kKnocks) {
      knock(probe);
    } else {
      stable(probe);
    }
  } else if (goes_on()) {
    unstable(TuningEnd::kSwings);
  }
}

/// At the end of each second: whether the motion is as wide as in the one before.
bool StiffnessTuner::goes_on() noexcept {
  if (elapsed_ % ticks(kWindow) != 0) return false;
  const double width = range_.diagonal();
  const bool same = width_ > 0.0 && width > (1.0 - kDecay) * width_;
  width_ = width;
  range_ = {};
  return same || elapsed_ > ticks(kLongest);
}

void StiffnessTuner::stable(const Vec3& probe) noexcept {
  if (!follows_ && force_ < plan_.knock && length_ < kLongestKnock) {
    force_ = std::min(kHarder * force_, plan_.knock);
    knocks_ = 0;
    knock(probe);
    return;
  }
  TuningResult& at = result();
  at.stable = stiffness_;
  at.leak = leak_;
  knocks_ = 0;
  if (at.unstable == 0.0) {
    if (stiffness_ >= plan_.most) {
      if (!moved_) at.stable = 0.0;  // that it never swung says nothing
      leave(moved_ ? TuningEnd::kMost : TuningEnd::kStuck);
      return;
    }
    stiffness_ = std::min(kGrowth * stiffness_, plan_.most);
  } else if (halvings_++ < kHalvings) {
    stiffness_ = std::sqrt(at.stable * at.unstable);
  } else {
    leave(failed_);
    return;
  }
  knock(probe);
}

void StiffnessTuner::unstable(TuningEnd how) noexcept {
  result().unstable = stiffness_;
  failed_ = how;
  stiffness_ = 0.0;
  elapsed_ = 0;
  phase_ = Phase::kCalm;
}

/// After the calm that follows a swing.
void StiffnessTuner::go_on() noexcept {
  const TuningResult& at = result();
  if (at.stable == 0.0 || halvings_++ >= kHalvings) {
    leave(failed_);
    return;
  }
  begin_draw(std::sqrt(at.stable * at.unstable));
}

void StiffnessTuner::begin_draw(double next) noexcept {
  point_ = last_;
  stiffness_ = plan_.least;
  next_ = next;
  elapsed_ = 0;
  phase_ = Phase::kDraw;
}

void StiffnessTuner::leave(TuningEnd how) noexcept {
  result().end = how;
  stiffness_ = 0.0;
  halvings_ = 0;
  moved_ = false;
  force_ = std::min(kFirstKnock, plan_.knock);
  elapsed_ = 0;
  if (++news_.place == news_.count) {
    news_.done = true;
    phase_ = Phase::kDone;
  } else {
    phase_ = Phase::kStart;
  }
}

}  // namespace palpate
