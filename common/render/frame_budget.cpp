#include "common/render/frame_budget.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <utility>

#include "common/base/check.h"

namespace palpate {
namespace {

constexpr double kRoom = 0.85;              // of the budget
constexpr double kLighter = 0.7;            // more than frames of one scene scatter
constexpr double kFarTooSlow = 2.0;         // a frame that takes this many budgets counts at once
constexpr int kPatience = 4, kLonger = 20;  // frames

// Rays cost by their samples, half of them in lenses where there are some; the rest of a frame by its pixels.
double cost_of(const FrameQuality& quality, bool lenses) {
  constexpr double kFixed = 0.1;
  const double focus = lenses ? 0.5 : 0.0;
  const double context = quality.context * quality.viewport * quality.viewport;
  const double samples = (1.0 - focus) * context + focus * quality.focus;
  return quality.resolution * quality.resolution * (kFixed + (1.0 - kFixed) * samples);
}

}  // namespace

std::vector<FrameQuality> quality_levels(bool volume, bool lenses) {
  std::vector<FrameQuality> levels{{}};
  const auto down = [&](double FrameQuality::*what, std::initializer_list<double> shares) {
    for (const double share : shares) {
      levels.push_back(levels.back());
      levels.back().*what = share;
    }
  };
  if (volume) down(&FrameQuality::context, {0.5, 0.25});
  if (volume && lenses) down(&FrameQuality::viewport, {0.5});
  down(&FrameQuality::resolution, {0.85, 0.7, 0.5, 0.35});
  if (volume && lenses) down(&FrameQuality::focus, {0.5});
  down(&FrameQuality::resolution, {0.25});
  return levels;
}

SceneView with_quality(SceneView view, const FrameQuality& quality) {
  if (!view.volume) return view;
  view.volume->samples_per_voxel *= quality.context;
  view.volume->context.viewport *= quality.viewport;
  for (Lens& lens : view.volume->lenses) lens.samples_per_voxel *= quality.focus;
  return view;
}

FrameBudget::FrameBudget(double milliseconds) : budget_(milliseconds) {
  PALPATE_CHECK(milliseconds > 0.0 && std::isfinite(milliseconds));
  show(false, false);
}

void FrameBudget::show(bool volume, bool lenses) {
  std::vector<FrameQuality> levels = quality_levels(volume, lenses);
  if (levels == levels_) return;
  levels_ = std::move(levels);
  costs_.clear();
  for (const FrameQuality& quality : levels_) costs_.push_back(cost_of(quality, lenses));
  since_.assign(levels_.size(), 0.0);
  level_ = finest_ = 0;
  changed_ = false;
  fast_ = 0;
}

void FrameBudget::go_to(std::size_t level) {
  changed_ = level != level_;
  level_ = level;
  fast_ = 0;
}

void FrameBudget::drawn(double milliseconds) {
  if (!(milliseconds > 0.0) || !std::isfinite(milliseconds)) return;
  // The first frame of a level makes tables for its steps, too: it is no measure, unless it was far too slow.
  if (std::exchange(changed_, false) && milliseconds <= kFarTooSlow * budget_) return;

  const auto expected = [&](std::size_t i) { return milliseconds * costs_[i] / costs_[level_]; };
  if (milliseconds > budget_) {
    if (level_ + 1 == levels_.size()) return;
    std::size_t next = level_ + 1;
    while (next + 1 < levels_.size() && expected(next) > budget_) ++next;
    finest_ = level_ + 1;
    since_.assign(levels_.size(), 0.0);
    go_to(next);
    return;
  }
  double& before = since_[level_];
  if (before == 0.0) before = milliseconds;
  if (milliseconds < kLighter * before) {
    finest_ = 0;
    before = milliseconds;
  }
  if (level_ <= finest_ || milliseconds > kRoom * budget_) {
    fast_ = 0;
    return;
  }
  ++fast_;
  const bool likely = expected(level_ - 1) <= kRoom * budget_;
  if (fast_ >= (likely ? kPatience : kLonger)) go_to(level_ - 1);
}

}  // namespace palpate
