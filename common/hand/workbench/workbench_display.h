/// What the screens of a workbench show to the head before them: one similarity places the data, each screen
/// is a window into it, and both eyes are where the head is.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/hand/technique/interaction_technique.h"
#include "common/hand/workbench/head_tracker.h"
#include "common/render/scene_view.h"

namespace palpate {

struct WorkbenchDisplayOptions {
  WorkbenchGeometry workbench;
  std::size_t screen = 0;            ///< which of its screens is the one that the camera is of
  std::shared_ptr<PoseSource> head;  ///< never null
  double separation = 0.063;         ///< of the eyes, where the workbench does not say it [m]
  bool several = false;              ///< a window for each screen, beside that of the desktop
};

/// Shows `view` as `screen` shows it to eyes that are there, all in data coordinates: one eye between both,
/// or both where the view is for two. An eye that is not before the screen, or nearer to it than a tenth of
/// its height, is taken to be that near: there is no such picture.
void look_through(const Screen& screen, const Eyes& eyes, SceneView& view);

class WorkbenchDisplay {
 public:
  /// @pre options.screen is one of options.workbench.screens.
  explicit WorkbenchDisplay(WorkbenchDisplayOptions options);

  /// @name The screen whose rectangle is that of the camera
  /// @{
  [[nodiscard]] const Screen& screen() const noexcept { return part_; }
  /// The part of it that the picture of a window covers, which has `width` x `height` pixels, `left` and
  /// `top` from the upper left corner of the desktop: all of it, where its pixels are not known. `camera` is
  /// changed with it, so that the data stays where it is. @return whether it is another part than before.
  bool cover(double left, double top, double width, double height, Camera& camera);
  /// Where the middle of the data is as the workbench says.
  [[nodiscard]] Camera camera(const Box& bounds, double workspace_scale) const;
  /// @}

  /// [s] of CLOCK_MONOTONIC, which trackers count by.
  [[nodiscard]] static double now();
  /// Looks where the head is. Once a frame. @param now [s] of the source's clock, such as now().
  void follow(double now);
  /// A picture was finished and handed to the display at `now`; what it took is looked ahead by from then on.
  void finished(double now);
  [[nodiscard]] const Eyes& eyes() const noexcept { return eyes_; }  ///< of the last follow()
  /// With the eyes of that time in `view`, whose camera is that of screen().
  void show(SceneView& view) const;
  /// The same for another screen of the workbench.
  void show(const Screen& other, SceneView& view) const;

  [[nodiscard]] const WorkbenchDisplayOptions& options() const noexcept { return options_; }
  /// Whether the view may move by itself.
  [[nodiscard]] bool lively() const;
  /// Whether the last follow() moved the eyes.
  [[nodiscard]] bool moved() const noexcept { return moved_; }
  /// From a motion of the head to the light that shows it [s]: the median of what was measured, and what the
  /// workbench says of sensor and display; 0 before anything was.
  [[nodiscard]] double latency() const noexcept;
  /// For the rates: what is told of head and latency, a name and a value each.
  [[nodiscard]] std::vector<std::pair<std::string, std::string>> rows() const;

 private:
  WorkbenchDisplayOptions options_;
  Screen part_;
  HeadTracker tracker_;
  LatencyMeter from_appearance_, from_sample_;  ///< to the end of the picture
  double looked_ = 0.0, sampled_ = 0.0;         ///< when
  bool waits_ = false;                          ///< for the picture of that look
  bool moved_ = false;
  Eyes eyes_;
};

}  // namespace palpate
