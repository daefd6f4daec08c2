#include <algorithm>
#include <cstddef>
#include <iterator>
#include <optional>
#include <utility>
#include <vector>

#include <GLFW/glfw3.h>
#include <imgui.h>

#include "common/base/index.h"
#include "common/hand/probe_picture.h"
#include "common/window/explorer_window.h"

namespace palpate {
namespace {

/// The events of this frame; others stay in `waiting` for the next one.
std::vector<InputEvent> take_events(std::vector<InputEvent>& waiting) {
  const auto end = waiting.begin() + static_cast<std::ptrdiff_t>(events_of_frame(waiting));
  std::vector<InputEvent> taken(std::make_move_iterator(waiting.begin()), std::make_move_iterator(end));
  waiting.erase(waiting.begin(), end);
  return taken;
}

/// A pointer is seen by both eyes where it is in both halves, at the same place.
void draw_second_pointer(const std::optional<Vec2>& there, float text_height) {
  if (!there || ImGui::GetIO().WantCaptureMouse) return;
  const ImVec2 at{static_cast<float>(there->x), static_cast<float>(there->y)};
  const float size = 0.8F * text_height;
  ImGui::GetForegroundDrawList()->AddTriangleFilled(
      at, {at.x, at.y + size}, {at.x + 0.7F * size, at.y + 0.7F * size}, IM_COL32(255, 255, 255, 230));
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
  // Screens of a workbench show the scene itself.
  picture_->place(parts.picture, view_, workbench_ != nullptr);
  gui_->set_background(view_.background);
  const std::vector<InputEvent> events = take_events(glfw_.events());
  gui_->begin_frame(events, width, height, seconds);
  const Document before = state_.document;
  look();
  // An orthographic picture has one eye, but a workbench's is never that.
  controls_.place(controlled(), has_two_eyes(view_) || (workbench_ && !screens_));
  handle_events(events);
  work_in_space();
  if (needs_camera_ && scene_) reset_camera();
  update_panels();
  PanelActions asked =
      on_start_page() ? draw_start_page(parts) : draw_panels(options_.panels, state_, view_, parts);
  if (auto series = series_choice_.draw()) asked.open = std::move(series);
  obey(asked);
  crosshair_.follow(view_);
  answer_questions();
  if (files_.follow_export()) glfwMakeContextCurrent(glfw_.get());
  follow_hand();
  news_.follow(touch_.readout(), touch_.data().levels().field != nullptr, state_);
  time_.follow(state_, scene_, jobs_.running());
  follow_layer();
  edits_.follow();
  if (!same_scene(state_.document, before)) jobs_.give_way();
  if (controls_.take_lens_moved()) picture_->live().moved(glfwGetTime());
  const SceneView picture = with_focus();
  draw_picture(picture, width, height);
  draw_second_pointer(controls_.second_pointer(), gui_->text_height());
  gui_->end_frame();
  if (screens_) screens_->draw(without_panes(picture), *workbench_, state_.picture.quality);
}

ControlledScene ExplorerWindow::controlled() {
  return {.scene = scene_ ? &*scene_ : nullptr,
          .view = view_,
          .picture = picture_->scene(),
          .panes = picture_->area(),
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
  if (cuts_.follow(touch_, view_)) picture_->live().moved(glfwGetTime());
  controls_.lead_by_grid(controlled());
  // Surfaces are solid: they would hide what is in a lens.
  const bool lenses =
      view_.volume && view_.volume->shown && (!view_.volume->lenses.empty() || is_cut(*view_.volume));
  view_.surfaces = lenses ? std::vector<SurfaceView>() : show_surfaces(touch_.data().surfaces().meshes);
  const std::vector<SurfaceView>& fixtures = touch_.data().fixture_views();
  view_.surfaces.insert(view_.surfaces.end(), fixtures.begin(), fixtures.end());
  if (scene_) view_.surfaces.insert(view_.surfaces.end(), scene_->surfaces.begin(), scene_->surfaces.end());
}

void ExplorerWindow::look() {
  if (!workbench_) return;
  workbench_->follow(WorkbenchDisplay::now());
  state_.head_rows = workbench_->rows();
  // The desktop beside several screens shows all of the one that its camera is of.
  if (screens_) return;
  const auto [left, top] = glfw_.position();
  const double scale = glfw_.pixels_per_coordinate();
  workbench_->cover(scale * left + picture_->scene().left, scale * top + picture_->scene().top,
                    picture_->scene().width, picture_->scene().height, view_.camera);
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

SceneView ExplorerWindow::with_focus() {
  SceneView picture = view_;
  const bool hand = touch_.readout().held || !touch_.trail().drawn_lines().entries().empty();
  // Those on a layer are its grain.
  const bool on_layer = scene_ && scene_->info->layers;
  if ((hand || !view_.surfaces.empty()) && !on_layer && touch_.choice().fade_rest) fade_lines(picture);
  controls_.decorate(controlled(), picture);
  picture.notes.insert(picture.notes.end(), state_.marks.begin(), state_.marks.end());
  return picture;
}

void ExplorerWindow::draw_picture(SceneView picture, int width, int height) {
  // The panel may have divided it otherwise.
  picture_->place(picture_->area(), view_, workbench_ != nullptr);
  if (glfw_.take_damage()) picture_->live().damage();
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
  if (touch_.planes()) moment.next_cut = as_size(touch_.planes()->current);
  if (workbench_ && !screens_) workbench_->show(picture);
  if (picture.stereo.mode == StereoMode::kRows || picture.stereo.mode == StereoMode::kColumns) {
    const auto [column, row] = pixel_on_monitor(glfw_.get());
    picture.stereo.first = {column + static_cast<int>(picture_->scene().left),
                            row + static_cast<int>(picture_->scene().top)};
  }
  picture_->draw(std::move(picture), view_, controls_.panes(), ImGui::GetIO().WantCaptureMouse, moment, width,
                 height);
  state_.picture = picture_->live().figures();
  if (!picture_->complete()) lively_frames_ = std::max(lively_frames_, 2);
}

}  // namespace palpate
