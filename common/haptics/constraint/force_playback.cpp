#include "common/haptics/constraint/force_playback.h"

#include <algorithm>

namespace palpate {

void ForcePlayback::update(const Vec3& probe, const UpdateBudget& /*budget*/, LinkUpdate& link) noexcept {
  link.proxy = probe;
  const double time = rows_->front().time + passed_;
  const auto after = std::upper_bound(rows_->begin(), rows_->end(), time,
                                      [](double t, const TimedForce& row) { return t < row.time; });
  link.at_end = after == rows_->end();
  if (link.at_end) return;
  const TimedForce& before = *(after - 1);
  const double part = (time - before.time) / (after->time - before.time);
  link.extra_force = (1.0 - part) * before.force + part * after->force;
  link.state = HoldState::kHeld;
}

}  // namespace palpate
