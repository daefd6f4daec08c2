/// Keeps frames within a time while something moves, with the least error that this leaves. Plain arithmetic,
/// no clock.
///
/// Levels. Of all qualities those are gone through that no other one beats: by error (QualityErrors, of which
/// what lies inside lenses counts most, so that these keep their quality longest) from the least on, each by
/// kCheaper faster than the one before (QualityTimes), the last one the fastest that there is. They are
/// chosen anew, by what is known of errors and times by then, when something begins to move and at each
/// change of level; a movement begins with the first one that is expected to keep the budget.
///
/// Symbols. T budget; t time of a frame at level l; c_i what the model has for level i.
///   too slow      t > T: on to the first coarser level with t c_i / c_l <= T; l is refused
///   room          t <= kRoom T in kPatience frames in a row: to the first level with t c_i / c_l <= kRoom T;
///                 or in kLonger frames, whatever is expected: one level finer is tried
/// A refused level, and those finer than it, are not gone to until frames of some level take less than
/// kLighter of what they took after the refusal, or so many frames have come that the machine may have been
/// busy with something else: kForgiving, and twice as many after each refusal. In an even scene the frames
/// settle.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "common/render/budget/frame_quality.h"
#include "common/render/budget/quality_errors.h"
#include "common/render/budget/quality_times.h"

namespace palpate {

class FrameBudget {
 public:
  /// @param milliseconds T > 0.
  explicit FrameBudget(double milliseconds);

  /// What pictures show; something else than before begins anew: with all that was asked for, the usual
  /// errors and times.
  void show(bool volume, bool lenses);
  /// Errors were measured; from the next begin() on they count.
  void learn(const QualityErrors& errors);
  /// A picture with all that was asked for took so long at rest [ms], or less where some of it was kept: for
  /// as long as no other time is known.
  void rested(double milliseconds);
  /// Something begins to move.
  void begin();
  /// For the next frame while something moves. At rest frames are drawn with all that was asked for, and are
  /// not measured here.
  [[nodiscard]] const FrameQuality& quality() const noexcept { return levels_[level_]; }
  /// A frame of quality() took so long [ms]; numbers that are no times are left out.
  void drawn(double milliseconds);

  [[nodiscard]] double milliseconds() const noexcept { return budget_; }
  [[nodiscard]] const std::vector<FrameQuality>& levels() const noexcept { return levels_; }
  [[nodiscard]] std::size_t level() const noexcept { return level_; }
  /// The error of quality() that measured ones let expect, of the whole picture; nothing before learn().
  [[nodiscard]] std::optional<double> expected_error() const noexcept;

 private:
  /// The levels that errors and times make, as known by now.
  [[nodiscard]] std::vector<FrameQuality> best_qualities() const;
  /// The first of `levels` that takes no longer than `time`, as times_ has it, else the last.
  [[nodiscard]] std::size_t first_within(const std::vector<FrameQuality>& levels, double time) const;
  [[nodiscard]] double refused_time() const;
  /// On with other levels, at `level` or the first one that takes less than what was refused.
  void choose(std::vector<FrameQuality> levels, double refused, std::size_t level);
  void too_slow(double milliseconds);
  void room(double milliseconds);

  double budget_;
  bool volume_ = false, lenses_ = false;
  QualityErrors errors_ = usual_errors();
  bool measured_ = false;  ///< they were
  QualityTimes times_;
  double rested_ = 0.0;  ///< most of the times at rest [ms]
  std::vector<FrameQuality> levels_;
  std::vector<double> since_;  ///< time of a level after the last refusal [ms], 0: not known
  std::size_t level_ = 0;
  std::size_t finest_ = 0;  ///< that is not refused
  int refused_ = 0;         ///< how often, since the scene is what it is
  int frames_ = 0;          ///< since the last time
  bool changed_ = false;    ///< the next frame is the first of its level, which also makes its tables
  int fast_ = 0;            ///< frames in a row with room
};

}  // namespace palpate
