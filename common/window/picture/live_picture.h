/// The picture of a window: drawn when something changed, coarser while something moves, refined at rest.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "common/render/budget/frame_budget.h"
#include "common/render/local_redraw.h"
#include "common/render/scene_renderer.h"
#include "common/render/scene_view.h"
#include "common/render/tract/tract_progress.h"

namespace palpate {

/// What is known of the picture that was drawn last.
struct PictureFigures {
  std::optional<ValueRange> automatic_range;  ///< that colours have while the view gives none
  double milliseconds = 0.0;
  double frames_per_second = 0.0;
  FrameQuality quality;
  std::optional<CoarserVoxels> coarser_voxels;  ///< as VolumePass
  BrickShare bricks;                            ///< likewise
  /// Of a volume at rest, as far as it is known: from a sparse set of its pixels.
  std::optional<ImageError> error;
  /// Of one that moves, where it has rested before: RMS, by what was given up
  /// (render/budget/quality_errors.h).
  std::optional<double> expected_error;
  TractShare tracts;
};

/// When a picture is asked for.
struct PictureMoment {
  double seconds = 0.0;  ///< of the window's clock
  bool moving = false;   ///< something is dragged or played: the budget holds
  bool editing =
      false;  ///< something of a panel is held: while that changes the volume, the budget holds, too
  /// Set while nobody waits for a picture: fewer are shown then, and more time is left for tracts, and to
  /// look at errors and to refine, until it returns true.
  std::function<bool()> interrupted;
  /// Asked while a picture of what rests is drawn: where something waits for an answer, that picture is left for
  /// the next call, and the last one stays.
  std::function<bool()> stop;
  /// The cut of the volume that may be moved next: while nobody waits, what does not change then is kept.
  std::optional<std::size_t> next_cut;
};

/// Needs the window's context from its construction to its end.
class LivePicture {
 public:
  /// @param budget of a picture while something moves [ms], above 0.
  explicit LivePicture(double budget) : budget_(budget), tract_time_(budget) {}

  /// The next picture is drawn whatever it shows: the window was uncovered, or the scene is another.
  void damage() { dirty_ = true; }
  /// A lens, a plane or the view was moved at `seconds`: until it has rested, pictures count as moving.
  void moved(double seconds) { moved_ = seconds; }

  /// Draws `width` x `height` pixels of `view` where they differ from what was drawn last, or more is to be
  /// added to them.
  void draw(SceneView view, int width, int height, const PictureMoment& moment);
  /// Copies the picture into the bound framebuffer. @param left, bottom its corner there [pixels].
  void show(int left, int bottom) { renderer_.show(left, bottom); }

  /// Whether nothing is left to be added, or to be kept for what comes next.
  [[nodiscard]] bool complete() const {
    return !left_ && renderer_.complete() && !preparing_ && !estimating_ && !saving_ && !refining_;
  }
  [[nodiscard]] const PictureFigures& figures() const { return figures_; }
  [[nodiscard]] auto read() { return renderer_.read(); }
  /// As SceneRenderer.
  [[nodiscard]] std::string tables_by() const { return renderer_.tables_by(); }
  /// Of all pictures [ms]; 0 where there are none.
  [[nodiscard]] double median_milliseconds() const;

 private:
  [[nodiscard]] bool is_edited(const SceneView& view) const;
  [[nodiscard]] bool stands(const SceneView& view, int width, int height) const;
  void begin_rest();
  void rest(const PictureMoment& moment, bool volume);
  void prepare(const PictureMoment& moment);
  void estimate_error(const PictureMoment& moment);
  void estimate_savings(const PictureMoment& moment);
  void refine(const PictureMoment& moment);

  SceneRenderer renderer_;
  FrameBudget budget_;
  LocalRedraw local_;
  TractTime tract_time_;             // what is left of tracts then is added by the next pictures
  SceneView shown_;                  // as it was drawn last
  std::optional<VolumeView> asked_;  // the volume as it was asked for last
  int width_ = 0, height_ = 0;
  bool dirty_ = true, preparing_ = false, moving_ = false;
  bool left_ = false;                  // the last picture was left: it is to be drawn yet
  std::optional<VolumeView> resting_;  // as it was asked for last: while it stands, what is known of it does
  Camera resting_camera_;
  bool estimating_ = false;                           // the error of the last picture is looked at
  bool error_known_ = false, savings_known_ = false;  // of this view, as well as may be
  bool saving_ = false;                               // what savings add to it is looked at
  bool refining_ = false, refined_ = false;
  bool passing_ = false;  // one pass over the picture, tile by tile, is under way
  int finer_ = 0;         // doublings of the samples that were asked for
  double moved_ = -1.0, edited_ = -1.0, last_drawn_ = 0.0;  // [s]
  std::vector<double> milliseconds_;
  PictureFigures figures_;
};

}  // namespace palpate
