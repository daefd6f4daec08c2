#include "common/render/budget/frame_budget.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/base/check.h"

namespace palpate {
namespace {

constexpr double kCheaper = 0.9;            // time of a level, of the one before
constexpr double kRoom = 0.85;              // of the budget
constexpr double kLighter = 0.7;            // more than frames of one scene scatter
constexpr double kFarTooSlow = 2.0;         // a frame that takes this many budgets counts at once
constexpr int kPatience = 4, kLonger = 20;  // frames
constexpr int kForgiving = 100, kMostRefused = 10;

}  // namespace

FrameBudget::FrameBudget(double milliseconds) : budget_(milliseconds) {
  PALPATE_CHECK(milliseconds > 0.0 && std::isfinite(milliseconds));
  levels_ = best_qualities();
  since_.assign(levels_.size(), 0.0);
}

void FrameBudget::show(bool volume, bool lenses) {
  if (volume == volume_ && lenses == lenses_) return;
  volume_ = volume;
  lenses_ = lenses;
  errors_ = usual_errors();
  measured_ = false;
  times_ = QualityTimes(volume, lenses);
  rested_ = 0.0;
  refused_ = frames_ = 0;
  choose(best_qualities(), HUGE_VAL, 0);
  changed_ = false;
}

void FrameBudget::learn(const QualityErrors& errors) {
  errors_ = errors;
  measured_ = true;
}

std::optional<double> FrameBudget::expected_error() const noexcept {
  if (!measured_) return std::nullopt;
  return errors_.rms(quality());
}

std::vector<FrameQuality> FrameBudget::best_qualities() const {
  std::vector<FrameQuality> all = frame_qualities(volume_, lenses_);
  // Savings that no error was found of keep their order, which begins with all that was asked for.
  std::stable_sort(all.begin(), all.end(), [&](const FrameQuality& a, const FrameQuality& b) {
    return weighed(errors_.of(a)) < weighed(errors_.of(b));
  });
  std::vector<FrameQuality> best{FrameQuality{}};
  for (const FrameQuality& quality : all) {
    if (times_.of(quality) < kCheaper * times_.of(best.back())) best.push_back(quality);
  }
  const auto time = [&](const FrameQuality& a, const FrameQuality& b) { return times_.of(a) < times_.of(b); };
  const FrameQuality& fastest = *std::min_element(all.begin(), all.end(), time);
  if (time(fastest, best.back())) best.push_back(fastest);
  return best;
}

std::size_t FrameBudget::first_within(const std::vector<FrameQuality>& levels, double time) const {
  std::size_t level = 0;
  while (level + 1 < levels.size() && times_.of(levels[level]) > time) ++level;
  return level;
}

double FrameBudget::refused_time() const { return finest_ > 0 ? times_.of(levels_[finest_ - 1]) : HUGE_VAL; }

void FrameBudget::choose(std::vector<FrameQuality> levels, double refused, std::size_t level) {
  constexpr double kBelow = 1.0 - 1e-9;
  const FrameQuality before = quality();
  levels_ = std::move(levels);
  finest_ = first_within(levels_, kBelow * refused);
  level_ = std::max(level, finest_);
  since_.assign(levels_.size(), 0.0);
  changed_ = quality() != before;
  fast_ = 0;
}

void FrameBudget::rested(double milliseconds) {
  if (milliseconds > 0.0 && std::isfinite(milliseconds)) rested_ = std::max(rested_, milliseconds);
}

void FrameBudget::begin() {
  if (!times_.known() && rested_ > 0.0) times_.add({}, rested_);
  std::vector<FrameQuality> levels = best_qualities();
  const std::size_t level = times_.known() ? first_within(levels, kRoom * budget_) : 0;
  choose(std::move(levels), refused_time(), level);
  changed_ = quality() != FrameQuality{};  // whose tables there are
}

void FrameBudget::too_slow(double milliseconds) {
  if (level_ + 1 == levels_.size()) return;
  const double slow = times_.of(quality());
  std::vector<FrameQuality> levels = best_qualities();
  const std::size_t level = first_within(levels, budget_ / milliseconds * slow);
  refused_ = std::min(refused_ + 1, kMostRefused);
  frames_ = 0;
  choose(std::move(levels), slow, level);
}

// Where the finest level that is expected to keep the budget is another one, or the next finer one after a
// long time, there.
void FrameBudget::room(double milliseconds) {
  if (++fast_ < kPatience) return;
  std::vector<FrameQuality> levels = best_qualities();
  const double now = times_.of(quality()), refused = refused_time();
  const std::size_t expected = first_within(levels, kRoom * budget_ / milliseconds * now);
  if (times_.of(levels[expected]) > now) return choose(std::move(levels), refused, expected);
  const std::size_t here = first_within(levels, now);
  if (fast_ >= kLonger && here > 0 && (refused_ == 0 || finest_ > 0))
    choose(std::move(levels), refused, here - 1);
}

void FrameBudget::drawn(double milliseconds) {
  if (!(milliseconds > 0.0) || !std::isfinite(milliseconds)) return;
  // The first frame of a level makes tables for its steps, too: it is no measure, unless it was far too slow.
  if (std::exchange(changed_, false)) {
    if (milliseconds > kFarTooSlow * budget_) too_slow(milliseconds);
    return;
  }
  times_.add(quality(), milliseconds);
  if (milliseconds > budget_) return too_slow(milliseconds);

  double& before = since_[level_];
  if (before == 0.0) before = milliseconds;
  if (milliseconds < kLighter * before) {
    finest_ = refused_ = 0;
    before = milliseconds;
  } else if (finest_ > 0 && ++frames_ >= kForgiving << (refused_ - 1)) {
    finest_ = 0;
  }
  if (level_ <= finest_ || milliseconds > kRoom * budget_) {
    fast_ = 0;
    return;
  }
  room(milliseconds);
}

}  // namespace palpate
