/// The picture in a window: the scene, slices beside it, and where each of them lies.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "common/render/slice/slice_panes.h"
#include "common/window/controls/pane_control.h"
#include "common/window/picture/live_picture.h"
#include "common/window/picture/pane_pictures.h"

namespace palpate {

/// `view` as the pane of its volume shows it, which changes with nothing of the others.
[[nodiscard]] SceneView without_panes(SceneView view);

/// Needs the window's context from its construction to its end.
class WindowPicture {
 public:
  /// @param budget as of LivePicture.
  explicit WindowPicture(double budget) : budget_(budget), live_(budget) {}

  /// It lies at `area` of the window, divided as `view` says, whose aspect becomes that of the scene's own pane.
  /// @param alone the scene itself is shown and nothing else.
  void place(const PictureArea& area, SceneView& view, bool alone);
  [[nodiscard]] const PictureArea& area() const noexcept { return area_; }  ///< all of it
  [[nodiscard]] const PictureArea& scene() const noexcept {
    return scene_;
  }  ///< the pane of the scene itself

  /// Draws `picture` and shows it in the window's framebuffer, `width` x `height` pixels.
  /// @param view as the user wants it, for what is written under the mouse, unless that is over a panel.
  void draw(SceneView picture, const SceneView& view, const PaneControl& panes, bool over_panel,
            const PictureMoment& moment, int width, int height);
  /// All panes of it, before `background`.
  [[nodiscard]] Image read(const Background& background);

  /// Whether what is beside the scene lacks nothing.
  [[nodiscard]] bool complete() const noexcept {
    return (!slices_ || slices_->complete()) && (!other_ || other_->complete());
  }
  [[nodiscard]] LivePicture& live() noexcept { return live_; }

 private:
  double budget_;
  LivePicture live_;
  std::unique_ptr<LivePicture> other_;    ///< of the scene beside it; none where there is none
  std::optional<Pane> other_half_;        ///< where that is, in `area_`
  std::unique_ptr<PanePictures> slices_;  ///< beside it; none until they are asked for
  PictureArea area_, scene_;
  std::vector<Pane> parts_;
};

}  // namespace palpate
