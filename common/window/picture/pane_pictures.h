/// The pictures of slices beside that of a volume, each drawn again where something about it changed.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "common/render/render_panes.h"
#include "common/render/scene_renderer.h"
#include "common/render/scene_view.h"
#include "common/render/slice/slice_panes.h"

namespace palpate {

/// Needs the window's context from its construction to its end.
class PanePictures {
 public:
  /// What of them has a slice, of a picture that holds `parts`. @pre scene.volume.
  /// @param under_mouse what is written in the pane `mouse_in`, which may be null.
  /// @param moving thick slabs are drawn from fewer planes.
  void draw(const SceneView& scene, const std::vector<Pane>& parts, const std::string& under_mouse,
            const Pane* mouse_in, bool moving);
  /// Whether they show all tracts that lie in their slabs: what there was no time for, the next call of draw() adds.
  [[nodiscard]] bool complete() const noexcept { return complete_; }
  /// The pixels of each.
  [[nodiscard]] std::vector<PaneImage> read() const;
  /// Copies them into the framebuffer that is bound. @param left, top of the picture, @param height of the
  /// framebuffer [pixels].
  void show(int left, int top, int height) const;

 private:
  struct Shown {
    Pane pane;
    SceneView view;
    std::unique_ptr<SceneRenderer> renderer;
  };
  std::vector<Shown> shown_;
  SceneView scene_;  // that they were drawn of last, as follows
  std::vector<Pane> parts_;
  std::string under_mouse_;
  bool moving_ = false;
  bool complete_ = true;
};

}  // namespace palpate
