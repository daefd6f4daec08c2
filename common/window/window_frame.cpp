#include <algorithm>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include <GLFW/glfw3.h>
#include <epoxy/gl.h>
#include <imgui.h>

#include "common/geometry/box_edges.h"
#include "common/hand/probe_picture.h"
#include "common/window/controls/plane_control.h"
#include "common/window/explorer_window.h"

namespace palpate {

void ExplorerWindow::draw_frame(double seconds) {
  int width = 0, height = 0;
  glfwGetFramebufferSize(glfw_.get(), &width, &height);
  if (width < 1 || height < 1) {  // iconified
    glfw_.events().clear();
    glfwWaitEventsTimeout(kIdleRest);
    return;
  }
  const WindowLayout parts = layout(width, height, gui_->text_height());
  picture_ = parts.picture;
  gui_->set_background(view_.background);
  const std::vector<InputEvent> events = take_events();
  gui_->begin_frame(events, width, height, seconds);
  look();
  menu_.place(view_.camera, picture_, touch_->device_reach());
  // An orthographic picture has one eye, but a workbench's is never that.
  const bool two = has_two_eyes(view_) || (bench_ && !screens_);
  pointer_.over(two ? view_.stereo : StereoView{}, picture_);
  handle_events(events);
  work_in_space();
  if (needs_camera_ && scene_) reset_camera();
  tell_panels();
  const SceneSettings settings_before = state_.settings;
  const PanelActions actions = draw_panels(state_, view_, parts);
  obey(actions);
  answer_question();
  follow_hand();
  tell_news();
  play();
  follow_layer();
  if (!(state_.settings == settings_before)) give_way();
  const SceneView picture = with_focus();
  draw_picture(picture, parts, width, height);
  draw_second_pointer();
  gui_->end_frame();
  if (screens_) screens_->draw(picture, *bench_, state_.picture.quality);
}

void ExplorerWindow::tell_panels() {
  state_.scene = scene_ ? &*scene_ : nullptr;
  state_.job = job_->running() && (job_kind_ != JobKind::kUpdate || is_slow()) ? &job_->progress() : nullptr;
  state_.marking = touch_control_->marking();
  state_.grabbed = touch_control_->grabbed() || touch_control_->waiting();
  const bool looking =
      view_.tensors && !control_.dragging() && !touch_->readout().held && !ImGui::GetIO().WantCaptureMouse;
  state_.tensor =
      looking ? slice_control_.under_mouse(pointer_.area(), seeing(), *view_.tensors) : std::nullopt;
  state_.series.reset();
  if (scene_) plot_.update(*scene_->info, scene_->settings.time_step, options_.threads, state_);
}

void ExplorerWindow::follow_hand() {
  if (bench_) touch_->place_bench(place_of(view_.camera, bench_->screen()));
  if (view_.probe) touch_->update(glfwGetTime(), view_.camera, view_.style.color_by, *view_.probe);
  cut_volume();
  lead_by_grid();
  follow_edits();
  // Surfaces are solid: they would hide what is in a lens.
  const bool lenses =
      view_.volume && view_.volume->shown && (!view_.volume->lenses.empty() || is_cut(*view_.volume));
  view_.surfaces = lenses ? std::vector<SurfaceView>() : show_surfaces(touch_->surfaces().meshes);
  if (scene_) view_.surfaces.insert(view_.surfaces.end(), scene_->surfaces.begin(), scene_->surfaces.end());
}

void ExplorerWindow::tell_news() {
  if (const int popped = touch_->readout().popped; popped != told_popped_) {
    if (popped > told_popped_)
      say(touch_->felt_levels().field ? "popped through to the other side" : "popped over to the next line",
          false);
    told_popped_ = popped;
  }
  if (touch_->readout().fault != told_fault_) {
    told_fault_ = touch_->readout().fault;
    say(told_fault_, true);
  }
  if (touch_->readout().device != told_device_) {
    told_device_ = touch_->readout().device;
    say(told_device_.empty() ? "the device is ready" : told_device_, false);
  }
}

void ExplorerWindow::cut_volume() {
  if (!touch_->planes() || !view_.volume) return;
  if (touch_->choice().settings.plane_widget.poses.count == 0) {
    const PlanePoses planes = planes_of(*view_.volume, view_.bounds.center());
    if (planes.count > 0) {
      touch_->begin_planes(planes);
      return;
    }
  }
  const PlanePoses& poses = touch_->planes()->poses;
  if (!(poses == cut_planes_)) live_->lens_moved(glfwGetTime());
  cut_by_planes(*view_.volume, poses, cut_planes_.count);
  cut_planes_ = poses;
}

void ExplorerWindow::lead_by_grid() {
  const bool holds = touch_->holds_on_grid();
  const Vec3& hand = touch_->readout().proxy;
  if (has_region()) region_control_.follow_hand(holds, hand, holds ? touch_->box_reach() : 0.0, view_.bounds);
  const std::optional<Vec3> left = view_hold_.follow(holds && !region_control_.dragging(), hand);
  if (!left) return;
  view_.camera.focal_point += *left;
  touch_->shift_hand(glfwGetTime(), *left);
}

void ExplorerWindow::look() {
  if (!bench_) return;
  bench_->follow(BenchDisplay::now());
  state_.head_rows = bench_->rows();
  // The desktop beside several screens shows all of the one that its camera is of.
  if (screens_) return;
  const auto [left, top] = glfw_.position();
  const double scale = glfw_.pixels_per_coordinate();
  bench_->cover(scale * left + picture_.left, scale * top + picture_.top, picture_.width, picture_.height,
                view_.camera);
}

void ExplorerWindow::reset_camera() {
  needs_camera_ = false;
  if (bench_) {
    view_.camera = bench_->camera(view_.bounds, options_.touch.workspace_scale);
    return;
  }
  view_.camera =
      make_camera(view_.bounds, options_.angles,
                  eye_aspect(view_.stereo.mode, picture_.width, picture_.height), view_.camera.projection);
  // Of the first view alone: a reset shows all there is.
  view_.camera.focal_point = std::exchange(focal_point_, {}).value_or(view_.camera.focal_point);
}

Camera ExplorerWindow::seeing() const {
  if (!bench_ || screens_) return seeing_camera(view_, pointer_.eye());
  SceneView seen = view_;
  bench_->show(seen);
  return seeing_camera(seen, pointer_.eye());
}

void ExplorerWindow::draw_second_pointer() const {
  const auto there = pointer_.twin();
  if (!there || ImGui::GetIO().WantCaptureMouse) return;
  const ImVec2 at{static_cast<float>(there->x), static_cast<float>(there->y)};
  const float size = 0.8F * gui_->text_height();
  ImGui::GetForegroundDrawList()->AddTriangleFilled(
      at, {at.x, at.y + size}, {at.x + 0.7F * size, at.y + 0.7F * size}, IM_COL32(255, 255, 255, 230));
}

std::optional<Vec3> ExplorerWindow::next_mark() const {
  if (touch_->notes().pending().empty()) return std::nullopt;
  SceneView seen = view_;
  seen.camera = seeing();
  return touch_control_->next_mark(pointer_.area(), seen);
}

SceneView ExplorerWindow::with_focus() const {
  SceneView picture = view_;
  if (const Vec3 moved = view_hold_.moved(); moved != Vec3{0.0}) {
    // The hand is drawn on the place of the scene that it has taken hold of.
    picture.camera.focal_point += moved;
    if (picture.probe) {
      picture.probe->probe += moved;
      picture.probe->proxy += moved;
      for (Vec3& proxy : picture.probe->links) proxy += moved;
    }
  }
  const bool hand = touch_->readout().held || !touch_->kept().entries().empty();
  // Those on a layer are its grain.
  const bool on_layer = scene_ && scene_->info->layers;
  if ((hand || !view_.surfaces.empty()) && !on_layer && touch_->choice().fade_rest) fade_lines(picture);
  if (auto menu = menu_.drawn()) picture.signs.push_back(std::move(*menu));
  picture.notes = notes_of(touch_->notes(), length_unit(picture), next_mark());
  if (const auto& picked = hand_in_space_.picked()) picture.notes.push_back(note_of(*picked));
  std::vector<std::vector<Vec3>> handled;
  if (touch_->planes())
    handled = lines_of_planes(touch_->planes()->poses, picture.bounds, touch_->sphere_radius());
  if (const auto lens = lens_control_.followed();
      lens && view_.volume && *lens < view_.volume->lenses.size()) {
    if (auto circle = outline_of(view_.volume->lenses[*lens], view_.camera); !circle.empty())
      handled.push_back(std::move(circle));
  }
  if (has_region()) {
    if (region_control_.box()) {
      for (auto& edge : box_edges(*region_control_.box())) handled.push_back(std::move(edge));
    }
    if (auto dots = region_control_.dots(); !dots.empty())
      picture.notes.push_back({.points = std::move(dots), .outline = {}, .words = {}});
  }
  if (!handled.empty() && picture.outline.empty()) picture.outline = box_edges(picture.bounds);
  picture.outline.insert(picture.outline.end(), handled.begin(), handled.end());
  return picture;
}

void ExplorerWindow::draw_picture(SceneView picture, const WindowLayout& parts, int width, int height) {
  const auto w = static_cast<int>(parts.picture.width), h = static_cast<int>(parts.picture.height);
  if (glfw_.take_damage()) live_->damage();
  PictureMoment moment{.seconds = glfwGetTime(),
                       .moving = control_.dragging() || slice_control_.dragging() || state_.playing ||
                                 (bench_ && bench_->moved()),
                       .editing = ImGui::IsAnyItemActive() && ImGui::IsMouseDown(ImGuiMouseButton_Left)};
  if (!lively() && !job_->running() && !scripted()) {
    moment.interrupted = [this] {
      glfwPollEvents();
      return !glfw_.events().empty();
    };
  }
  if (touch_->planes()) moment.next_cut = static_cast<std::size_t>(touch_->planes()->current);
  if (bench_ && !screens_) bench_->show(picture);
  if (picture.stereo.mode == StereoMode::kRows || picture.stereo.mode == StereoMode::kColumns) {
    const auto [column, row] = pixel_on_monitor(glfw_.get());
    picture.stereo.first = {column + static_cast<int>(parts.picture.left),
                            row + static_cast<int>(parts.picture.top)};
  }
  live_->draw(std::move(picture), w, h, moment);
  state_.picture = live_->figures();
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  glViewport(0, 0, width, height);
  live_->show(static_cast<int>(parts.picture.left), height - h);
}

}  // namespace palpate
