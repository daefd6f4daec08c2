#include "common/render/tract/tract_progress.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace palpate {
namespace {

constexpr std::size_t kGrowth = 4;  // of parts: all of them together take a third more than the last one
// Shares of the budget: what tracts and all else take, less than all of it, so that frames that scatter keep
// to it; and what tracts take at least.
constexpr double kRoomOfAll = 0.8, kLeastOfAll = 0.2;

}  // namespace

double opacity_of_part(double opacity, double share) noexcept { return std::min(1.0, opacity / share); }

void TractProgress::begin(std::size_t pieces, double opacity, std::size_t expected) noexcept {
  pieces_ = pieces;
  opacity_ = opacity;
  next_ = shown_ = 0;
  goal_ =
      opacity < 1.0 ? std::clamp<std::size_t>(expected, std::min<std::size_t>(1, pieces), pieces) : pieces;
  begun_ = first_part_ = true;
}

bool TractProgress::begins_anew() noexcept {
  if (std::exchange(begun_, false)) return true;
  if (next_ < goal_ || goal_ == pieces_) return false;
  next_ = 0;
  goal_ = std::min(kGrowth * goal_, pieces_);
  first_part_ = false;
  return true;
}

double TractProgress::opacity() const noexcept {
  if (goal_ == pieces_) return opacity_;
  return opacity_of_part(opacity_, static_cast<double>(goal_) / static_cast<double>(pieces_));
}

void TractProgress::drawn(std::size_t next) noexcept {
  next_ = next;
  if (worth_showing()) shown_ = next_;
}

double TractTime::milliseconds(bool moving) const noexcept {
  const double rest = moving ? rest_ : 0.0;
  return std::max(kLeastOfAll * budget_, kRoomOfAll * budget_ - rest);
}

void TractTime::drawn(double picture, double tracts) noexcept {
  const double rest = picture - tracts;
  if (!(rest >= 0.0) || !std::isfinite(rest)) return;
  rest_ = rest_ > 0.0 ? 0.5 * (rest_ + rest) : rest;
}

}  // namespace palpate
