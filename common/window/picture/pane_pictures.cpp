#include "common/window/picture/pane_pictures.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace palpate {

void PanePictures::draw(const SceneView& scene, const std::vector<Pane>& parts,
                        const std::string& under_mouse, const Pane* mouse_in, bool moving) {
  // Outlines of many lenses take time.
  const std::string words =
      mouse_in != nullptr ? std::to_string(mouse_in - parts.data()) + under_mouse : std::string();
  if (parts == parts_ && words == under_mouse_ && moving == moving_ && complete_ &&
      same_picture(scene, scene_))
    return;
  scene_ = scene;
  parts_ = parts;
  under_mouse_ = words;
  moving_ = moving;
  complete_ = true;
  std::erase_if(shown_, [&](const Shown& one) {
    return std::none_of(parts.begin(), parts.end(),
                        [&](const Pane& pane) { return pane.plane == one.pane.plane; });
  });
  SceneRenderer* drawing = nullptr;
  for (const Pane& pane : parts) {
    if (!pane.plane || pane.width < 1 || pane.height < 1) continue;
    SceneView view = pane_view(scene, scene.volume->panes, parts, pane);
    if (mouse_in != nullptr && *mouse_in == pane) view.subtitle = under_mouse;
    constexpr int kPlanesWhileMoving = 12;
    if (moving) view.slice->most_planes = kPlanesWhileMoving;
    auto at = std::find_if(shown_.begin(), shown_.end(),
                           [&](const Shown& one) { return one.pane.plane == pane.plane; });
    if (at == shown_.end()) {
      shown_.push_back({.pane = {}, .view = {}, .renderer = std::make_unique<SceneRenderer>()});
      at = std::prev(shown_.end());
    } else if (at->pane.width == pane.width && at->pane.height == pane.height &&
               same_picture(at->view, view) && at->renderer->complete()) {
      at->pane = pane;
      continue;
    }
    constexpr double kTractTime = 25.0;  // [ms] of a frame
    // While one is drawn the values of the next are taken.
    if (drawing != nullptr) drawing->leave();
    drawing = at->renderer.get();
    drawing->draw(view, pane.width, pane.height, 1.0, kTractTime);
    complete_ = complete_ && drawing->complete();
    at->pane = pane;
    at->view = std::move(view);
  }
  if (drawing != nullptr) (void)drawing->finish();  // what comes next is timed alone
}

std::vector<PaneImage> PanePictures::read() const {
  std::vector<PaneImage> images;
  for (const Shown& one : shown_) images.push_back({one.pane, one.renderer->read()});
  return images;
}

void PanePictures::show(int left, int top, int height) const {
  for (const Shown& one : shown_)
    one.renderer->show(left + one.pane.left, height - top - one.pane.top - one.pane.height);
}

}  // namespace palpate
