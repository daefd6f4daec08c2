#include <algorithm>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include <GLFW/glfw3.h>
#include <epoxy/gl.h>
#include <imgui.h>

#include "common/hand/probe_picture.h"
#include "common/window/controls/plane_control.h"
#include "common/window/explorer_window.h"

namespace palpate {
namespace {

/// What the volume's own pane shows, which changes with nothing of the others.
SceneView without_panes(SceneView view) {
  if (!view.volume) return view;
  view.volume->panes = {};
  if (!shows_planes(*view.volume)) view.volume->planes.window.reset();
  return view;
}

}  // namespace

void ExplorerWindow::draw_frame(double seconds) {
  int width = 0, height = 0;
  glfwGetFramebufferSize(glfw_.get(), &width, &height);
  if (width < 1 || height < 1) {  // iconified
    glfw_.events().clear();
    glfwWaitEventsTimeout(kIdleRest);
    return;
  }
  const WindowLayout parts = layout(width, height, gui_->text_height(), state_.show_panel);
  panes_ = parts.picture;
  place_picture();
  gui_->set_background(view_.background);
  const std::vector<InputEvent> events = take_events();
  gui_->begin_frame(events, width, height, seconds);
  const Document before = state_.document;
  look();
  // An orthographic picture has one eye, but a workbench's is never that.
  controls_.place(controlled(), has_two_eyes(view_) || (workbench_ && !screens_));
  handle_events(events);
  work_in_space();
  if (needs_camera_ && scene_) reset_camera();
  update_panels();
  obey(on_start_page() ? draw_start_page(parts) : draw_panels(options_.panels, state_, view_, parts));
  answer_questions();
  follow_export();
  follow_hand();
  news_.follow(touch_, state_);
  play();
  follow_layer();
  follow_edits();
  if (!same_scene(state_.document, before)) jobs_.give_way();
  if (controls_.take_lens_moved()) live_->moved(glfwGetTime());
  const SceneView picture = with_focus();
  draw_picture(picture, width, height);
  draw_second_pointer();
  gui_->end_frame();
  if (screens_) screens_->draw(without_panes(picture), *workbench_, state_.picture.quality);
}

ControlledScene ExplorerWindow::controlled() {
  return {.scene = scene_ ? &*scene_ : nullptr,
          .view = view_,
          .picture = picture_,
          .panes = panes_,
          .workbench = workbench_.get(),
          .beside_screens = screens_ != nullptr,
          .time = glfwGetTime()};
}

void ExplorerWindow::update_panels() {
  state_.scene = scene_ ? &*scene_ : nullptr;
  state_.job = jobs_.shown_progress(state_.playing);
  state_.marking = controls_.touch().marking();
  state_.grabbed = controls_.touch().grabbed() || controls_.touch().waiting();
  state_.tensor = ImGui::GetIO().WantCaptureMouse ? std::nullopt : controls_.tensor_under_mouse(controlled());
  state_.series.reset();
  if (scene_)
    plot_.update(*scene_->info, time_step_of(scene_->document, scene_->info->times), options_.threads,
                 state_);
}

void ExplorerWindow::follow_hand() {
  if (workbench_) touch_.hand().place_workbench(place_of(view_.camera, workbench_->screen()));
  if (view_.probe) touch_.update(glfwGetTime(), view_.camera, view_.style, *view_.probe);
  cut_volume();
  controls_.lead_by_grid(controlled());
  // Surfaces are solid: they would hide what is in a lens.
  const bool lenses =
      view_.volume && view_.volume->shown && (!view_.volume->lenses.empty() || is_cut(*view_.volume));
  view_.surfaces = lenses ? std::vector<SurfaceView>() : show_surfaces(touch_.data().surfaces().meshes);
  if (scene_) view_.surfaces.insert(view_.surfaces.end(), scene_->surfaces.begin(), scene_->surfaces.end());
}

void ExplorerWindow::cut_volume() {
  if (!touch_.planes() || !view_.volume) return;
  if (touch_.choice().settings.plane_widget.poses.count == 0) {
    const PlanePoses planes = planes_of(*view_.volume, view_.bounds.center());
    if (planes.count > 0) {
      touch_.put_planes(planes);
      return;
    }
  }
  const PlanePoses& poses = touch_.planes()->poses;
  if (!(poses == cut_planes_)) live_->moved(glfwGetTime());
  cut_by_planes(*view_.volume, poses, cut_planes_.count);
  cut_planes_ = poses;
}

void ExplorerWindow::look() {
  if (!workbench_) return;
  workbench_->follow(WorkbenchDisplay::now());
  state_.head_rows = workbench_->rows();
  // The desktop beside several screens shows all of the one that its camera is of.
  if (screens_) return;
  const auto [left, top] = glfw_.position();
  const double scale = glfw_.pixels_per_coordinate();
  workbench_->cover(scale * left + picture_.left, scale * top + picture_.top, picture_.width, picture_.height,
                    view_.camera);
}

void ExplorerWindow::reset_camera() {
  needs_camera_ = false;
  if (workbench_) {
    view_.camera = workbench_->camera(view_.bounds, options_.touch.workspace_scale);
    return;
  }
  view_.camera = make_camera(view_.bounds, angles_, view_.aspect, view_.camera.projection);
  // Of the first view alone: a reset shows all there is.
  view_.camera.focal_point = std::exchange(focal_point_, {}).value_or(view_.camera.focal_point);
}

void ExplorerWindow::draw_second_pointer() const {
  const auto there = controls_.second_pointer();
  if (!there || ImGui::GetIO().WantCaptureMouse) return;
  const ImVec2 at{static_cast<float>(there->x), static_cast<float>(there->y)};
  const float size = 0.8F * gui_->text_height();
  ImGui::GetForegroundDrawList()->AddTriangleFilled(
      at, {at.x, at.y + size}, {at.x + 0.7F * size, at.y + 0.7F * size}, IM_COL32(255, 255, 255, 230));
}

SceneView ExplorerWindow::with_focus() {
  SceneView picture = view_;
  const bool hand = touch_.readout().held || !touch_.trail().drawn_lines().entries().empty();
  // Those on a layer are its grain.
  const bool on_layer = scene_ && scene_->info->layers;
  if ((hand || !view_.surfaces.empty()) && !on_layer && touch_.choice().fade_rest) fade_lines(picture);
  controls_.decorate(controlled(), picture);
  return picture;
}

std::vector<Pane> ExplorerWindow::panes() const {
  // Screens of a workbench show the scene itself.
  const SlicePanes alone;
  return panes_of(view_.volume && !workbench_ ? view_.volume->panes : alone, static_cast<int>(panes_.width),
                  static_cast<int>(panes_.height));
}

void ExplorerWindow::place_picture() {
  for (const Pane& pane : panes()) {
    if (pane.plane) continue;
    picture_ = {panes_.left + pane.left, panes_.top + pane.top, static_cast<double>(pane.width),
                static_cast<double>(pane.height)};
  }
  view_.aspect = eye_aspect(view_.stereo.mode, picture_.width, picture_.height);
}

void ExplorerWindow::draw_picture(SceneView picture, int width, int height) {
  place_picture();  // the panel may have divided it otherwise
  const auto w = static_cast<int>(picture_.width), h = static_cast<int>(picture_.height);
  if (glfw_.take_damage()) live_->damage();
  PictureMoment moment{
      .seconds = glfwGetTime(),
      .moving = controls_.moves_view() || state_.playing || (workbench_ && workbench_->moved()),
      .editing = ImGui::IsAnyItemActive() && ImGui::IsMouseDown(ImGuiMouseButton_Left)};
  if (!lively() && !jobs_.running() && !scripted()) {
    moment.interrupted = [this] {
      glfwPollEvents();
      return !glfw_.events().empty();
    };
  }
  if (!scripted()) {
    moment.stop = [this] {
      glfwPollEvents();
      return glfwWindowShouldClose(glfw_.get()) == GLFW_TRUE || wants_answer(glfw_.events());
    };
  }
  if (touch_.planes()) moment.next_cut = static_cast<std::size_t>(touch_.planes()->current);
  if (workbench_ && !screens_) workbench_->show(picture);
  if (picture.stereo.mode == StereoMode::kRows || picture.stereo.mode == StereoMode::kColumns) {
    const auto [column, row] = pixel_on_monitor(glfw_.get());
    picture.stereo.first = {column + static_cast<int>(picture_.left), row + static_cast<int>(picture_.top)};
  }
  const std::vector<Pane> parts = panes();
  if (parts.size() < 2) {
    slices_.reset();
  } else {
    if (!slices_) slices_ = std::make_unique<PanePictures>();
    const bool over_panel = ImGui::GetIO().WantCaptureMouse;
    slices_->draw(picture, parts,
                  over_panel ? std::string() : controls_.panes().words_under_mouse(panes_, parts, view_),
                  over_panel ? nullptr : controls_.panes().pane_under_mouse(panes_, parts),
                  controls_.panes().dragging() || (moment.editing && picture.volume->panes.slab > 0.0));
  }
  picture = without_panes(std::move(picture));
  live_->draw(std::move(picture), w, h, moment);
  state_.picture = live_->figures();
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  glViewport(0, 0, width, height);
  // What a hint or a banner has left between the pictures.
  glClearColor(0.0F, 0.0F, 0.0F, 1.0F);
  glClear(GL_COLOR_BUFFER_BIT);
  live_->show(static_cast<int>(picture_.left), height - static_cast<int>(picture_.top) - h);
  if (slices_) slices_->show(static_cast<int>(panes_.left), static_cast<int>(panes_.top), height);
}

}  // namespace palpate
