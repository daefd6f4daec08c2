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
  make_levels();
}

void FrameBudget::show(bool volume, bool lenses) {
  if (volume == volume_ && lenses == lenses_) return;
  volume_ = volume;
  lenses_ = lenses;
  errors_ = usual_errors();
  measured_ = false;
  times_ = QualityTimes(volume, lenses);
  rested_ = 0.0;
  level_ = finest_ = 0;
  refused_ = frames_ = 0;
  changed_ = false;
  make_levels();
}

void FrameBudget::learn(const QualityErrors& errors) {
  errors_ = errors;
  measured_ = true;
}

std::optional<double> FrameBudget::expected_error() const noexcept {
  if (!measured_) return std::nullopt;
  return errors_.rms(quality());
}

void FrameBudget::make_levels() {
  std::vector<FrameQuality> all = frame_qualities(volume_, lenses_);
  // Savings that no error was found of keep their order, which begins with all that was asked for.
  std::stable_sort(all.begin(), all.end(), [&](const FrameQuality& a, const FrameQuality& b) {
    return weighed(errors_.of(a)) < weighed(errors_.of(b));
  });
  std::vector<FrameQuality> levels{FrameQuality{}};
  for (const FrameQuality& quality : all) {
    if (times_.of(quality) < kCheaper * times_.of(levels.back())) levels.push_back(quality);
  }
  const auto time = [&](const FrameQuality& a, const FrameQuality& b) { return times_.of(a) < times_.of(b); };
  const FrameQuality& fastest = *std::min_element(all.begin(), all.end(), time);
  if (time(fastest, levels.back())) levels.push_back(fastest);
  since_.assign(levels.size(), 0.0);
  fast_ = 0;
  levels_ = std::move(levels);
}

void FrameBudget::rested(double milliseconds) {
  if (milliseconds > 0.0 && std::isfinite(milliseconds)) rested_ = std::max(rested_, milliseconds);
}

void FrameBudget::begin() {
  if (!times_.known() && rested_ > 0.0) times_.add({}, rested_);
  // What was refused stays so, by its time.
  const double refused = finest_ > 0 ? times_.of(levels_[finest_ - 1]) : HUGE_VAL;
  make_levels();
  finest_ = 0;
  while (finest_ + 1 < levels_.size() && times_.of(levels_[finest_]) >= refused) ++finest_;
  level_ = finest_;
  while (times_.known() && level_ + 1 < levels_.size() && times_.of(levels_[level_]) > kRoom * budget_)
    ++level_;
  changed_ = quality() != FrameQuality{};
}

void FrameBudget::go_to(std::size_t level) {
  changed_ = level != level_;
  level_ = level;
  fast_ = 0;
}

double FrameBudget::expected(std::size_t level, double milliseconds) const noexcept {
  return milliseconds * times_.of(levels_[level]) / times_.of(levels_[level_]);
}

void FrameBudget::too_slow(double milliseconds) {
  if (level_ + 1 == levels_.size()) return;
  std::size_t next = level_ + 1;
  while (next + 1 < levels_.size() && expected(next, milliseconds) > budget_) ++next;
  finest_ = level_ + 1;
  refused_ = std::min(refused_ + 1, kMostRefused);
  frames_ = 0;
  since_.assign(levels_.size(), 0.0);
  go_to(next);
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
  ++fast_;
  std::size_t next = finest_;
  while (next + 1 < level_ && expected(next, milliseconds) > kRoom * budget_) ++next;
  const bool likely = expected(next, milliseconds) <= kRoom * budget_;
  if (likely ? fast_ >= kPatience : fast_ >= kLonger && (refused_ == 0 || finest_ > 0)) go_to(next);
}

}  // namespace palpate
