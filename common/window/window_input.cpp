#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <GLFW/glfw3.h>
#include <imgui.h>
#include <imgui_internal.h>

#include "common/base/error.h"
#include "common/base/text.h"
#include "common/compose/appearance.h"
#include "common/compose/volume_scene.h"
#include "common/render/scene_parts.h"
#include "common/scene/time_steps.h"
#include "common/window/event_text.h"
#include "common/window/explorer_window.h"
#include "common/window/files/dropped_files.h"
#include "common/window/keys.h"
#include "common/window/panels/panel_parts.h"
#include "common/window/panels/panes_panel.h"
#include "common/window/panels/picture_panels.h"

namespace palpate {
namespace {

constexpr const char* kOneTime = "there is one time step only";
constexpr const char* kNothingOpen = "nothing is open yet";

bool has_bar(const SceneView& view) {
  return has_colored_lines(view) || view.volume || view.tensors || view.tracts;
}

/// What is said of a key that means nothing; nothing of keys that make no letter.
std::optional<std::string> unknown_key(const InputEvent& event) {
  constexpr int kOthers = kModifierControl | kModifierAlt;
  const bool printed = event.kind == InputKind::kKeyDown && event.key > ' ' && event.key < 127;
  if (!printed || (event.modifiers & kOthers) != 0) return std::nullopt;
  return std::string(1, static_cast<char>(event.key)) + " does nothing; H lists the keys";
}

/// Shows the volume or hides it. @return what to tell the user. @param scene null: nothing is open.
std::string toggle_volume(SceneView& view, const SceneState* scene) {
  if (view.volume) {
    view.volume->shown = !view.volume->shown;
    return view.volume->shown ? "the volume is shown" : "the volume is hidden; V shows it again";
  }
  if (scene == nullptr) return kNothingOpen;
  return scene->info->volumes.empty() ? "there is no volume here"
                                      : "no volume is drawn: choose one in the panel (volume of)";
}

}  // namespace

void ExplorerWindow::handle_events(const std::vector<InputEvent>& events) {
  const ImGuiIO& io = ImGui::GetIO();
  for (const InputEvent& event : events) {
    if (event.kind == InputKind::kDrop && !files_.asking()) open(event.files);
    // What is typed into a dialog is for no replay.
    if (const std::string text = event_text(event);
        !text.empty() && !files_.asking() && !state_.search.asking())
      touch_.servo().record_event(static_cast<std::uint64_t>(frame_), text);
    const auto command = command_of(event);
    // The one key that works in text fields, too.
    if (command == Command::kForceOff) run_command(*command);
    controls_.follow_pointer(event, controlled());
    // Notch by notch the wheel moves what is looked at.
    if (event.kind == InputKind::kWheel && !io.WantCaptureMouse) picture_->live().moved(glfwGetTime());
    if (files_.handle(event) || state_.search.handle(event)) continue;
    if (on_start_page()) {
      handle_on_start_page(event);
      continue;
    }
    say(controls_.handle(event, controlled(), io.WantCaptureMouse, io.WantTextInput));
    // Esc closes an open list, and nothing else.
    const bool of_list =
        command == Command::kLetGo && ImGui::IsPopupOpen(nullptr, ImGuiPopupFlags_AnyPopupId);
    if (of_list) ImGui::ClosePopupToLevel(0, true);
    if (command && !io.WantTextInput && !of_list && command != Command::kForceOff) run_command(*command);
    if (!command && !io.WantTextInput) say(unknown_key(event));
  }
}

void ExplorerWindow::handle_on_start_page(const InputEvent& event) {
  const auto command = command_of(event);
  if (command == Command::kLetGo && !state_.show_help && !state_.log.shown && scene_) {
    start_asked_ = false;
    return;
  }
  if (start_page_.handle(event) || !command) return;
  constexpr std::array kHere{Command::kMessages, Command::kOpen,       Command::kQuit,      Command::kHelp,
                             Command::kLetGo,    Command::kFullScreen, Command::kStartPage, Command::kClose};
  if (std::ranges::find(kHere, *command) != kHere.end()) run_command(*command);
}

PanelActions ExplorerWindow::draw_start_page(const WindowLayout& parts) {
  begin_controls();
  thumbnails_->draw_missing(start_page_.examples(), [] { glfwPostEmptyEvent(); });
  const StartPage::Actions asked = start_page_.draw(
      state_.recent, [this](const InputFiles& input) { return thumbnails_->of(input); }, scene_.has_value(),
      state_.error.empty() ? state_.message : state_.error);
  draw_overlays(state_, parts);
  PanelActions actions;
  actions.ask_to_open = asked.ask_to_open;
  actions.open = asked.open;
  return actions;
}

void ExplorerWindow::open(const std::vector<std::filesystem::path>& files) try {
  std::vector<InputFiles> beside;
  const InputFiles sorted = sort_dropped(files, scene_ ? &scene_->info->files : nullptr, beside);
  if (!sorted.files.empty() || !sorted.session.empty()) {
    leave({Leaving::Way::kOpen, sorted, beside});
    return;
  }
  if (!scene_) throw usage_error("open data first: the table goes into what is shown");
  Document with = state_.document;
  take_tables(sorted, with);
  state_.document = with;
  state_.seeds = seed_choice(with.tracing.seeds);
} catch (const Error& error) {
  state_.fail(error.what());
}

void ExplorerWindow::leave(const Leaving& leaving) {
  if (files_.ask(leaving)) {
    controls_.touch().let_go();
  } else {
    go_on(leaving);
  }
}

void ExplorerWindow::go_on(const Leaving& leaving) {
  switch (leaving.way) {
    case Leaving::Way::kOpen:
      jobs_.open(leaving.files, leaving.beside);
      break;
    case Leaving::Way::kClose:
      close_data();
      break;
    case Leaving::Way::kQuit:
      leave_ = true;
      glfwSetWindowShouldClose(glfw_.get(), GLFW_TRUE);
  }
}

void ExplorerWindow::answer_questions() {
  if (const auto leaving = files_.answer()) go_on(*leaving);
  if (scene_) say(state_.search.draw(state_.document, options_.kind));
  if (const auto name = take_reset(); name && scene_) state_.say(edits_.reset(*name));
  const auto chosen = files_.chosen();
  if (!chosen) return;
  switch (chosen->what) {
    case WindowFiles::Chosen::What::kOpen:
      open(chosen->files);
      break;
    case WindowFiles::Chosen::What::kSession:
      edits_.keep();
      files_.save_session(model_, state_.document, chosen->files.front());
      break;
    case WindowFiles::Chosen::What::kPicture:
      files_.export_picture(with_focus(), chosen->files.front(), picture_texts());
  }
}

void ExplorerWindow::save_session(bool asks) {
  edits_.keep();
  if (!scene_) {
    state_.say(kNothingOpen);
  } else if (asks || files_.session().empty()) {
    controls_.touch().let_go();
    files_.ask_for_session(state_.document);
  } else {
    files_.save_session(model_, state_.document, files_.session());
  }
}

void ExplorerWindow::obey(const PanelActions& actions) {
  if (actions.cancel) jobs_.cancel();
  if (actions.reset_camera) needs_camera_ = true;
  if (actions.look) run_command(*actions.look);
  if (actions.time && has_times(scene_))
    set_time_step(state_.document, scene_->info->times, nearest_step(scene_->info->times, *actions.time));
  if (actions.open) leave({Leaving::Way::kOpen, *actions.open});
  if (actions.ask_to_open) run_command(Command::kOpen);
  if (actions.save_picture) run_command(Command::kSavePicture);
  if (actions.export_picture) run_command(Command::kExportPicture);
  if (actions.save_session) run_command(Command::kSaveSession);
  if (actions.touch.grab) run_command(Command::kGrab);
  if (actions.touch.keep) run_command(Command::kKeepLine);
  if (actions.touch.undo) run_command(Command::kUndo);
  if (actions.touch.save_lines) run_command(Command::kSaveLines);
  if (actions.touch.mark) controls_.touch().mark(!controls_.touch().marking());
  files_.save_asked(actions, view_, controls_.region().box());
  if (actions.lens) say(controls_.follow_lens(*actions.lens));
}

void ExplorerWindow::run_command(Command command) {
  switch (command) {
    case Command::kHelp:
      state_.show_help = !state_.show_help;
      break;
    case Command::kSearch:
      if (scene_) {
        controls_.touch().let_go();
        state_.search.open();
      } else {
        state_.say(kNothingOpen);
      }
      break;
    case Command::kMessages:
      state_.log.shown = !state_.log.shown;
      break;
    case Command::kPanel:
      state_.show_panel = !state_.show_panel;
      if (!state_.show_panel) state_.say("Tab shows the panel again");
      break;
    case Command::kFullScreen:
      glfw_.toggle_full_screen();
      break;
    case Command::kResetCamera:
      needs_camera_ = true;
      break;
    case Command::kPlay:
      // Along layers there are no lines to keep.
      if (controls_.touch().grabbed() && (touch_.data().has_flow() || touch_.data().has_tensors())) {
        say(controls_.run(Command::kKeepLine, controlled()));
      } else if (has_times(scene_)) {
        state_.playing = !state_.playing;
      } else {
        state_.say(scene_ ? kOneTime : kNothingOpen);
      }
      break;
    case Command::kStepBack:
    case Command::kStepOn:
      state_.playing = false;
      step_in_time(state_.document, scene_, command == Command::kStepOn);
      if (!has_times(scene_)) state_.say(scene_ ? kOneTime : kNothingOpen);
      break;
    case Command::kLetGo:
      let_go();
      break;
    case Command::kQuit:
      glfwSetWindowShouldClose(glfw_.get(), GLFW_TRUE);
      break;
    case Command::kUndo:
      state_.say(edits_.undo());
      break;
    case Command::kRedo:
      state_.say(edits_.redo());
      break;
    case Command::kMenu:
      controls_.toggle_menu(controlled());
      if (!scene_) state_.say(kNothingOpen);
      break;
    case Command::kVolume:
      state_.say(toggle_volume(view_, scene_ ? &*scene_ : nullptr));
      break;
    case Command::kLayout:
      if (!scene_ || !view_.volume || !(scene_->is_volume_alone() || !view_.volume->slice_images.empty())) {
        state_.say("S shows slices next to a volume: there is none, or something else is shown in it");
      } else {
        next_layout(*view_.volume, state_.histogram.of(view_.volume->image));
      }
      break;
    case Command::kLens:
      // What it shows is sampled before it is there.
      if (scene_ && scene_->info->layers && !view_.color_lens) add_color_lens(view_, state_.document.heart);
      say(controls_.run(command, controlled()));
      break;
    case Command::kColorBar:
      view_.show_color_bar = !view_.show_color_bar;
      if (scene_ && view_.show_color_bar && !has_bar(view_))
        state_.say("nothing here is coloured by a number");
      break;
    case Command::kAxes:
      view_.show_axes = !view_.show_axes;
      break;
    case Command::kRates:
      state_.show_rates = !state_.show_rates;
      break;
    case Command::kSavePicture:
      files_.save_picture(picture_->read(view_.background), picture_texts());
      break;
    case Command::kSaveSession:
    case Command::kSaveSessionAs:
      save_session(command == Command::kSaveSessionAs);
      break;
    case Command::kExportPicture:
      if (!scene_) {
        state_.say(kNothingOpen);
        break;
      }
      controls_.touch().let_go();
      files_.ask_for_picture(static_cast<int>(picture_->area().width),
                             static_cast<int>(picture_->area().height));
      break;
    case Command::kOpen:
      controls_.touch().let_go();
      files_.ask_to_open(options_.kind);
      break;
    case Command::kStartPage:
      controls_.touch().let_go();
      start_asked_ = !start_asked_;
      break;
    case Command::kClose:
      if (scene_ || jobs_.busy()) {
        leave({Leaving::Way::kClose});
      } else {
        state_.say(kNothingOpen);
      }
      break;
    case Command::kSaveLines:
      files_.save_lines();
      break;
    default:
      say(controls_.run(command, controlled()));
  }
}

void ExplorerWindow::let_go() {
  controls_.let_go();
  state_.show_help = state_.log.shown = state_.playing = false;
  if (jobs_.running() && jobs_.kind() != SceneJobs::Kind::kStart) jobs_.cancel();
  state_.say({});
}

void ExplorerWindow::work_in_space() {
  say(controls_.work_in_space(controlled()));
  if (!controls_.menu().shown()) return;
  for (const Command command : controls_.menu().act(*scene_, state_.document, view_)) run_command(command);
}

std::vector<PngText> ExplorerWindow::picture_texts() const {
  return {{"Software", options_.version}, {"Comment", options_.command_line}};
}

}  // namespace palpate
