#include <cstddef>
#include <iterator>
#include <optional>
#include <string>
#include <vector>

#include <GLFW/glfw3.h>
#include <imgui.h>

#include "common/render/stereo/screen_camera.h"
#include "common/window/event_text.h"
#include "common/window/explorer_window.h"
#include "common/window/keys.h"

namespace palpate {

std::vector<InputEvent> ExplorerWindow::take_events() {
  std::vector<InputEvent>& waiting = glfw_.events();
  const auto end = waiting.begin() + static_cast<std::ptrdiff_t>(events_of_frame(waiting));
  std::vector<InputEvent> taken(std::make_move_iterator(waiting.begin()), std::make_move_iterator(end));
  waiting.erase(waiting.begin(), end);
  return taken;
}

void ExplorerWindow::handle_events(const std::vector<InputEvent>& events) {
  const ImGuiIO& io = ImGui::GetIO();
  for (const InputEvent& event : events) {
    pointer_.follow(event);
    const Aim aim(view_.camera, seeing());
    if (event.kind == InputKind::kDrop && !question_.asking()) open({event.files, {}});
    if (const std::string text = event_text(event); !text.empty()) {
      touch_->record_event(static_cast<std::uint64_t>(frame_), text);
    }
    const auto command = command_of(event);
    // The one key that works in text fields, too.
    if (command == Command::kForceOff) run_command(*command);
    if (question_.handle(event)) continue;
    const bool begins = event.kind == InputKind::kPress || event.kind == InputKind::kWheel;
    const bool key = event.kind == InputKind::kKeyDown || event.kind == InputKind::kKeyUp;
    const bool of_panel =
        (begins && io.WantCaptureMouse && !control_.dragging()) || (key && io.WantTextInput);
    // A lens that follows the mouse is left where it is clicked, whatever the hand could take there.
    const bool of_lens =
        event.kind == InputKind::kPress && (lens_control_.followed() || color_lens_control_.followed());
    if (!of_panel && !menu_.handle(event, pointer_.area(), view_.camera) &&
        !handle_region(event, pointer_.area()) && !handle_plane_image(event, pointer_.area()) &&
        !(of_lens && handle_lens(event, pointer_.area())) &&
        !touch_control_->handle(event, pointer_.area(), view_, glfwGetTime(), io.WantCaptureMouse) &&
        !handle_lens(event, pointer_.area()) &&
        !(view_.tensors && slice_control_.handle(event, pointer_.area(), view_.camera, *view_.tensors))) {
      control_.handle(event, pointer_.area(), view_.bounds, view_.camera);
    } else if (event.kind == InputKind::kMove) {
      control_.place(event.x, event.y);
      slice_control_.place(event.x, event.y);
    }
    // An open list takes Esc for itself.
    const bool of_list =
        command == Command::kLetGo && ImGui::IsPopupOpen(nullptr, ImGuiPopupFlags_AnyPopupId);
    if (command && !io.WantTextInput && !of_list && command != Command::kForceOff) run_command(*command);
  }
}

bool ExplorerWindow::handle_region(const InputEvent& event, const PictureArea& area) {
  if (!has_region() || (touch_control_->grabbed() && event.kind != InputKind::kMove)) return false;
  return region_control_.handle(event, area, view_.camera, view_.bounds);
}

bool ExplorerWindow::handle_plane_image(const InputEvent& event, const PictureArea& area) {
  if (!view_.volume) return false;
  const bool taken = plane_image_control_.handle(event, area, view_.camera, *view_.volume);
  if (plane_image_control_.dragging()) live_->lens_moved(glfwGetTime());
  return taken;
}

bool ExplorerWindow::handle_lens(const InputEvent& event, const PictureArea& area) {
  bool taken = false;
  if (scene_ && scene_->info->layers) {
    taken = color_lens_control_.handle(event, area, {scene_->felt_scalar, scene_->settings.layer}, view_);
  } else if (view_.volume) {
    if (lens_control_.followed()) live_->lens_moved(glfwGetTime());
    taken = lens_control_.handle(event, area, view_.camera, view_.bounds, *view_.volume);
  }
  // Where it is left, what was said of moving it is over.
  if (taken && event.kind == InputKind::kPress) say({}, false);
  return taken;
}

void ExplorerWindow::obey(const PanelActions& actions) {
  if (actions.cancel) job_->cancel();
  if (actions.reset_camera) needs_camera_ = true;
  if (actions.look) run_command(*actions.look);
  if (actions.time && has_times())
    state_.settings.time_step = nearest_step(scene_->info->times, *actions.time);
  if (actions.open) open(*actions.open);
  if (actions.save_picture) run_command(Command::kSavePicture);
  if (actions.save_session) run_command(Command::kSaveSession);
  if (actions.touch.grab) run_command(Command::kGrab);
  if (actions.touch.keep) run_command(Command::kKeepLine);
  if (actions.touch.undo) run_command(Command::kUndo);
  if (actions.touch.save_lines) run_command(Command::kSaveLines);
  if (actions.touch.mark) touch_control_->mark(!touch_control_->marking());
  save_asked(actions);
  if (actions.lens) say(lens_control_.follow(*actions.lens), false);
}

void ExplorerWindow::run_command(Command command) {
  switch (command) {
    case Command::kHelp:
      state_.show_help = !state_.show_help;
      break;
    case Command::kFullScreen:
      glfw_.toggle_full_screen();
      break;
    case Command::kResetCamera:
      needs_camera_ = true;
      break;
    case Command::kPlay:
      // Along layers there are no lines to keep.
      if (touch_control_->grabbed() && (touch_->has_flow() || touch_->has_tensors())) {
        run_touch(Command::kKeepLine);
      } else if (has_times())
        state_.playing = !state_.playing;
      break;
    case Command::kStepBack:
    case Command::kStepOn:
      state_.playing = false;
      step_in_time(command == Command::kStepOn);
      break;
    case Command::kLetGo:
      let_go();
      break;
    case Command::kQuit:
      glfwSetWindowShouldClose(glfw_.get(), GLFW_TRUE);
      break;
    case Command::kCorner:
      put_corner();
      break;
    case Command::kUndo:
      if (!undo_view_edit()) run_touch(command);
      break;
    case Command::kMenu:
      toggle_menu();
      break;
    case Command::kVolume:
      if (view_.volume) view_.volume->shown = !view_.volume->shown;
      break;
    case Command::kLens:
    case Command::kLensSmaller:
    case Command::kLensLarger:
      run_lens(command);
      break;
    case Command::kColorBar:
      view_.show_color_bar = !view_.show_color_bar;
      break;
    case Command::kAxes:
      view_.show_axes = !view_.show_axes;
      break;
    case Command::kRates:
      state_.show_rates = !state_.show_rates;
      break;
    case Command::kSavePicture:
      attempt([this] { return files_.save_picture(live_->read(), picture_texts()); });
      break;
    case Command::kSaveSession:
      if (scene_) attempt([this] { return model_.save_session(scene_->settings, view_, set_options()); });
      break;
    case Command::kSaveLines:
      attempt([this] { return save_lines(); });
      break;
    default:
      run_touch(command);
  }
}

void ExplorerWindow::let_go() {
  control_.let_go();
  slice_control_.let_go();
  lens_control_.let_go();
  color_lens_control_.follow(false);
  plane_image_control_.let_go();
  region_control_.let_go();
  touch_control_->let_go();
  touch_control_->mark(false);
  state_.show_help = state_.playing = false;
  if (job_->running() && job_kind_ != JobKind::kStart) job_->cancel();
  say({}, false);
}

void ExplorerWindow::put_corner() {
  if (!has_region()) return;
  if (touch_->readout().held) {
    say(region_control_.put_corner(touch_->readout().proxy), false);
  } else {
    say("grab the probe (G) first: the corner is put where it is", false);
  }
}

void ExplorerWindow::run_lens(Command command) {
  if (scene_ && scene_->info->layers) {
    if (command == Command::kLens && state_.settings.lens_array.empty())
      state_.settings.lens_array = scene_->info->color_arrays.front();  // is sampled before it is there
    say(color_lens_control_.run(command, view_), false);
    return;
  }
  if (!scene_ || !view_.volume) return;
  say(lens_control_.run(command, pointer_.area(), view_.camera, view_.bounds, scene_->look(0), *view_.volume),
      false);
  live_->lens_moved(glfwGetTime());
}

void ExplorerWindow::run_touch(Command command) {
  if (ViewControl::look(command, view_.bounds, eye_aspect(view_.stereo.mode, picture_.width, picture_.height),
                        view_.camera))
    return;
  if (view_.tensors && SliceControl::run(command, *view_.tensors)) return;
  if (const auto words = touch_control_->run(command, pointer_.area(), view_, glfwGetTime()))
    say(*words, false);
}

void ExplorerWindow::work_in_space() {
  Camera seeing = view_.camera;
  if (bench_) {
    // Between both eyes, where they are before the screen.
    const Eyes& eyes = bench_->eyes();
    const Vec3 viewer = place_of(view_.camera, bench_->screen())(0.5 * (eyes[0] + eyes[1]));
    if (glm::dot(viewer - seeing.focal_point, seeing.axes[2]) > 0.0) seeing = seen_from(seeing, viewer);
  }
  const auto words = hand_in_space_.follow(menu_, *touch_, view_, seeing, pointer_.area(), glfwGetTime());
  if (words) say(*words, false);
  if (hand_in_space_.holding()) live_->lens_moved(glfwGetTime());
  if (!menu_.shown()) return;
  for (const Command command : menu_.act(state_.settings, view_)) run_command(command);
}

void ExplorerWindow::toggle_menu() {
  if (!scene_) return;
  std::vector<std::string> modes;
  for (const HapticMode& mode : touch_->modes()) modes.push_back(mode.name);
  menu_.toggle(*scene_, view_, modes);
  touch_->engage(false);
}

EditedView ExplorerWindow::edited_view() const {
  return {region_control_.box(), view_.volume ? view_.volume->planes.window : std::nullopt};
}

void ExplorerWindow::follow_edits() {
  if (!view_.volume) return;
  const bool resting =
      !region_control_.dragging() && !plane_image_control_.dragging() && !ImGui::IsAnyItemActive();
  view_edits_.follow(edited_view(), cut_planes_, resting);
}

bool ExplorerWindow::undo_view_edit() {
  if (!view_.volume || touch_control_->marking()) return false;
  const auto before = view_edits_.undo(cut_planes_);
  if (!before) return false;
  region_control_.put(before->region);
  view_.volume->planes.window = before->window;
  say("undone", false);
  return true;
}

}  // namespace palpate
