#include <algorithm>
#include <array>
#include <cstddef>
#include <iterator>
#include <optional>
#include <string>
#include <vector>

#include <GLFW/glfw3.h>
#include <imgui.h>
#include <imgui_internal.h>

#include "common/base/error.h"
#include "common/base/text.h"
#include "common/compose/appearance.h"
#include "common/compose/line_view.h"
#include "common/compose/slice_panes_text.h"
#include "common/compose/slice_plane.h"
#include "common/compose/volume_scene.h"
#include "common/render/scene_parts.h"
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

/// Panes as they are set, seen from where `from` is: where one looks is no edit.
PanesOptions looked_at(PanesOptions panes, const PanesOptions& from) {
  panes.cross = from.cross;
  panes.turn = from.turn;
  panes.center = from.center;
  panes.zoom = from.zoom;
  return panes;
}

}  // namespace

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
    if (event.kind == InputKind::kWheel && !io.WantCaptureMouse) live_->moved(glfwGetTime());
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
      state_.message);
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
  if (const auto name = take_reset()) reset_setting(*name);
  const auto chosen = files_.chosen();
  if (!chosen) return;
  switch (chosen->what) {
    case WindowFiles::Chosen::What::kOpen:
      open(chosen->files);
      break;
    case WindowFiles::Chosen::What::kSession:
      keep_document();
      files_.save_session(model_, state_.document, chosen->files.front());
      break;
    case WindowFiles::Chosen::What::kPicture:
      export_picture(chosen->files.front());
  }
}

void ExplorerWindow::reset_setting(const std::string& name) {
  if (!scene_) return;
  keep_document();
  const FieldKind kind = state_.document.input.kind;
  const Setting* const row = find_setting(name, kind) != nullptr ? find_setting(name, kind) : &setting(name);
  Document with = state_.document;
  set_value(*row, with, default_text(*row));
  apply_appearance(with, view_);
  if (view_.volume) view_.volume->panes = slice_panes_of(with.panes, view_.volume->image->bounds());
  if (view_.volume && (name == "window" || name == "level")) view_.volume->planes.window.reset();
  if (touch_.available()) touch_.restore(with.touch);
  put_region(with.slice.box);
  state_.document = with;
  state_.seeds = seed_choice(with.tracing.seeds);
  state_.say(row->label() +
             " is as in the beginning: " + (default_text(*row).empty() ? "as found" : default_text(*row)));
}

void ExplorerWindow::export_picture(const std::filesystem::path& file) {
  files_.picture().ask(with_focus(), file, picture_texts());
  state_.say("drawing " + file.string() + " …");
}

void ExplorerWindow::follow_export() {
  const auto outcome = files_.picture().take();
  if (!outcome) return;
  glfwMakeContextCurrent(glfw_.get());
  if (outcome->done) {
    state_.say("saved " + outcome->words);
  } else {
    state_.fail(outcome->words);
  }
}

void ExplorerWindow::save_session(bool asks) {
  keep_document();
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
  if (actions.time && has_times())
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
      } else if (has_times()) {
        state_.playing = !state_.playing;
      } else {
        state_.say(scene_ ? kOneTime : kNothingOpen);
      }
      break;
    case Command::kStepBack:
    case Command::kStepOn:
      state_.playing = false;
      step_in_time(command == Command::kStepOn);
      if (!has_times()) state_.say(scene_ ? kOneTime : kNothingOpen);
      break;
    case Command::kLetGo:
      let_go();
      break;
    case Command::kQuit:
      glfwSetWindowShouldClose(glfw_.get(), GLFW_TRUE);
      break;
    case Command::kUndo:
      state_.say(undo());
      break;
    case Command::kRedo:
      state_.say(redo());
      break;
    case Command::kMenu:
      controls_.toggle_menu(controlled());
      if (!scene_) state_.say(kNothingOpen);
      break;
    case Command::kVolume:
      toggle_volume();
      break;
    case Command::kLayout:
      if (!scene_ || !view_.volume || !scene_->is_volume_alone()) {
        state_.say("S shows slices beside a volume: there is none, or something else is shown in it");
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
      files_.save_picture(whole_picture(), picture_texts());
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
      files_.ask_for_picture(static_cast<int>(panes_.width), static_cast<int>(panes_.height));
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

void ExplorerWindow::toggle_volume() {
  if (view_.volume) {
    view_.volume->shown = !view_.volume->shown;
    state_.say(view_.volume->shown ? "the volume is shown" : "the volume is hidden; V shows it again");
  } else if (!scene_) {
    state_.say(kNothingOpen);
  } else {
    state_.say(scene_->info->volumes.empty() ? "there is no volume here"
                                             : "no volume is drawn: choose one in the panel (volume of)");
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

void ExplorerWindow::keep_document() {
  if (!scene_ || needs_camera_) return;
  Document& document = state_.document;
  if (!same_picture(view_, kept_) || view_.aspect != kept_.aspect) {
    model_.keep(view_, document);
    kept_ = view_;
  }
  const auto& box = controls_.region().box();
  document.slice.box = box && controlled().has_region() ? box_text(*box) : std::string();
  document.series.plot = state_.plotted;
  document.view.play_rate = state_.play_rate;
  touch_.keep(document.touch);
}

bool ExplorerWindow::dragging() const {
  const auto& planes = touch_.planes();
  const bool plane = planes && planes->state != WidgetState::kFree && touch_.readout().acts;
  // Time that plays, and layers that the hand goes through, are one edit each.
  const bool layers = scene_ && scene_->info->layers && touch_.readout().held;
  return state_.playing || plane || layers || !controls_.resting() || ImGui::IsAnyItemActive();
}

ExplorerWindow::Edited ExplorerWindow::edited() const {
  Edited now{.document = state_.document, .made = touch_.trail().made(), .view = edits_of(view_)};
  now.document.view.camera.clear();
  now.document.view.focal.clear();
  now.document.panes = looked_at(now.document.panes, {});
  return now;
}

void ExplorerWindow::follow_edits() {
  if (!scene_ || needs_camera_) return;
  keep_document();
  if (!history_) {
    history_.emplace(edited());
  } else if (history_->now().document.touch.planes.planes.empty() &&
             !state_.document.touch.planes.planes.empty()) {
    history_->settle(edited());  // planes that a mode begins with are no edit
  } else if (!dragging()) {
    history_->push(edited());
  }
}

std::string ExplorerWindow::undo() {
  // A point of what is being marked is in no document yet.
  if (controls_.touch().marking() && touch_.notes().take_back()) return "undone";
  keep_document();
  if (history_) history_->push(edited());
  if (!history_ || !history_->can_undo()) return "nothing to undo";
  restore(history_->undo());
  return "undone";
}

std::string ExplorerWindow::redo() {
  keep_document();
  if (history_) history_->push(edited());
  if (!history_ || !history_->can_redo()) return "nothing to restore";
  restore(history_->redo());
  return "restored";
}

void ExplorerWindow::restore(const Edited& to) {
  const ViewOptions seen = state_.document.view;
  const PanesOptions seen_panes = state_.document.panes;
  state_.document = to.document;
  state_.document.view.camera = seen.camera;
  state_.document.view.focal = seen.focal;
  state_.document.panes = looked_at(to.document.panes, seen_panes);
  state_.seeds = seed_choice(to.document.tracing.seeds);
  state_.plotted = to.document.series.plot;
  state_.play_rate = to.document.view.play_rate;
  apply_appearance(to.document, view_);
  put_edits(to.view, *scene_, view_);
  if (view_.volume)
    view_.volume->panes = slice_panes_of(state_.document.panes, view_.volume->image->bounds());
  put_region(to.document.slice.box);
  touch_.restore(to.document.touch);
  // The first cuts stand for as many planes of the hand as there were then.
  if (touch_.planes()) cut_planes_.count = touch_.choice().settings.plane_widget.poses.count;
  touch_.trail().put(to.made);
  // What the document says in other words now is no edit.
  keep_document();
  history_->settle(edited());
}

Image ExplorerWindow::whole_picture() {
  Image own = live_->read();
  if (!slices_) return own;
  std::vector<PaneImage> parts = slices_->read();
  for (const Pane& pane : panes()) {
    if (!pane.plane && pane.width == own.width && pane.height == own.height)
      parts.push_back({pane, std::move(own)});
  }
  return join_panes(parts, view_.background, static_cast<int>(panes_.width), static_cast<int>(panes_.height));
}

std::vector<PngText> ExplorerWindow::picture_texts() const {
  return {{"Software", options_.version}, {"Comment", options_.command_line}};
}

}  // namespace palpate
