/// Keeps frames within a time while something moves, by giving up quality in a fixed order: samples along
/// rays outside lenses first, then pixels there, then pixels, inside lenses last (Ikits 2006, sec. 5.7.3).
/// Plain arithmetic, no clock.
///
/// Symbols. T budget; t time of a frame at level l; c_i cost that level i is expected to have, relative to
/// the others.
///   too slow      t > T: on to the first coarser level with t c_i / c_l <= T; l is refused
///   room          t <= kRoom T in kPatience frames in a row, and t c_i / c_l <= kRoom T, too, one level
///   finer: there;
///                 or in kLonger frames, whatever is expected of that level: it is tried
/// A refused level, and those finer than it, are not gone to until frames of some level take less than
/// kLighter of what they took after the refusal: in an even scene every level is tried at most once, and the
/// frames settle.
#pragma once

#include <cstddef>
#include <vector>

#include "common/render/scene_view.h"

namespace palpate {

/// What a frame gives up, as shares of what was asked for, in (0, 1].
struct FrameQuality {
  double context = 1.0;     ///< of the samples along rays, outside lenses
  double focus = 1.0;       ///< likewise, inside lenses
  double viewport = 1.0;    ///< of the pixels along either edge, outside lenses where there are some
  double resolution = 1.0;  ///< of the pixels along either edge

  bool operator==(const FrameQuality&) const = default;
};

/// From all that was asked for to the coarsest, the order of the header; each takes less work than the one
/// before.
[[nodiscard]] std::vector<FrameQuality> quality_levels(bool volume, bool lenses);

/// The view drawn with `quality`; the resolution is for the renderer.
[[nodiscard]] SceneView with_quality(SceneView view, const FrameQuality& quality);

class FrameBudget {
 public:
  /// @param milliseconds T > 0.
  explicit FrameBudget(double milliseconds);

  /// The levels fit what is shown; other levels than before begin anew, at the finest.
  void show(bool volume, bool lenses);
  /// For the next frame while something moves. At rest frames are drawn with all that was asked for, and are
  /// not measured here.
  [[nodiscard]] const FrameQuality& quality() const noexcept { return levels_[level_]; }
  /// A frame of quality() took so long [ms]; numbers that are no times are left out.
  void drawn(double milliseconds);

  [[nodiscard]] double milliseconds() const noexcept { return budget_; }
  [[nodiscard]] std::size_t level() const noexcept { return level_; }

 private:
  void go_to(std::size_t level);

  double budget_;
  std::vector<FrameQuality> levels_;
  std::vector<double> costs_;  ///< c
  std::vector<double> since_;  ///< time of a level after the last refusal [ms], 0: not known
  std::size_t level_ = 0;
  std::size_t finest_ = 0;  ///< that is not refused
  bool changed_ = false;    ///< the next frame is the first of its level, which also makes its tables
  int fast_ = 0;            ///< frames in a row with room
};

}  // namespace palpate
