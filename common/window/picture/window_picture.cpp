#include "common/window/picture/window_picture.h"

#include <utility>

#include <epoxy/gl.h>

#include "common/render/render_panes.h"
#include "common/render/stereo/stereo_view.h"

namespace palpate {

SceneView without_panes(SceneView view) {
  if (!view.volume) return view;
  view.volume->panes = {};
  if (!shows_planes(*view.volume)) view.volume->planes.window.reset();
  return view;
}

void WindowPicture::place(const PictureArea& area, SceneView& view, bool alone) {
  area_ = area;
  other_half_.reset();
  if (view.beside && !alone && !has_two_eyes(view)) {
    const auto [left, right] = halves_of(static_cast<int>(area.width), static_cast<int>(area.height));
    parts_ = {left};
    other_half_ = right;
    scene_ = {area.left, area.top, static_cast<double>(left.width), static_cast<double>(left.height)};
    view.aspect = scene_.width / scene_.height;
    return;
  }
  parts_ = panes_of(view.volume && !alone ? view.volume->panes : SlicePanes(), static_cast<int>(area.width),
                    static_cast<int>(area.height));
  for (const Pane& pane : parts_) {
    if (pane.plane) continue;
    scene_ = {area.left + pane.left, area.top + pane.top, static_cast<double>(pane.width),
              static_cast<double>(pane.height)};
  }
  view.aspect = eye_aspect(view.stereo.mode, scene_.width, scene_.height);
}

void WindowPicture::draw(SceneView picture, const SceneView& view, const PaneControl& panes, bool over_panel,
                         const PictureMoment& moment, int width, int height) {
  if (parts_.size() < 2) {
    slices_.reset();
  } else {
    if (!slices_) slices_ = std::make_unique<PanePictures>();
    slices_->draw(picture, parts_, over_panel ? std::string() : panes.words_under_mouse(area_, parts_, view),
                  over_panel ? nullptr : panes.pane_under_mouse(area_, parts_),
                  panes.dragging() || (moment.editing && picture.volume->panes.slab > 0.0));
  }
  if (!other_half_) {
    other_.reset();
  } else {
    if (!other_) other_ = std::make_unique<LivePicture>(budget_);
    other_->draw(beside_view(picture), other_half_->width, other_half_->height, moment);
  }
  const auto w = static_cast<int>(scene_.width), h = static_cast<int>(scene_.height);
  live_.draw(without_panes(std::move(picture)), w, h, moment);
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  glViewport(0, 0, width, height);
  // What a hint or a banner has left between the pictures.
  glClearColor(0.0F, 0.0F, 0.0F, 1.0F);
  glClear(GL_COLOR_BUFFER_BIT);
  live_.show(static_cast<int>(scene_.left), height - static_cast<int>(scene_.top) - h);
  if (other_half_)
    other_->show(static_cast<int>(area_.left) + other_half_->left,
                 height - static_cast<int>(area_.top) - other_half_->height);
  if (slices_) slices_->show(static_cast<int>(area_.left), static_cast<int>(area_.top), height);
}

Image WindowPicture::read(const Background& background) {
  Image own = live_.read();
  if (other_) {
    return join_panes({{parts_.front(), std::move(own)}, {*other_half_, other_->read()}}, background,
                      static_cast<int>(area_.width), static_cast<int>(area_.height));
  }
  if (!slices_) return own;
  std::vector<PaneImage> images = slices_->read();
  for (const Pane& pane : parts_) {
    if (!pane.plane && pane.width == own.width && pane.height == own.height)
      images.push_back({pane, std::move(own)});
  }
  return join_panes(images, background, static_cast<int>(area_.width), static_cast<int>(area_.height));
}

}  // namespace palpate
