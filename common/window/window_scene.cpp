#include <algorithm>
#include <exception>
#include <string>
#include <utility>
#include <vector>

#include <GLFW/glfw3.h>

#include "common/base/error.h"
#include "common/base/text.h"
#include "common/compose/appearance.h"
#include "common/compose/line_view.h"
#include "common/hand/drawn/drawn_lines.h"
#include "common/hand/probe_picture.h"
#include "common/load/series_list.h"
#include "common/window/explorer_window.h"
#include "common/window/shown_scene.h"
#include "common/window/user_settings.h"

namespace palpate {
namespace {

constexpr const char* kCancelled = "cancelled; what is shown is as before";

}  // namespace

void ExplorerWindow::take_outcome() {
  if (auto outcome = jobs_.take()) {
    if (jobs_.closing()) {
      // What was being read is not wanted any more.
    } else if (outcome->scene) {
      adopt(std::move(*outcome->scene));
    } else {
      fail(outcome->error);
    }
    picture_->live().damage();
  }
  jobs_.start_next(scene_ ? state_.document : jobs_.requested());
}

void ExplorerWindow::adopt(SceneState scene) {
  const bool settled = edits_.settled();
  if (!scene.joined && jobs_.kind() == SceneJobs::Kind::kOpen) keep_thumbnail();
  if (scene_) keep_colors(scene_->document, scene, state_.picture.automatic_range, view_.style);
  scene_ = std::move(scene);
  using Kind = SceneJobs::Kind;
  const bool new_input = !scene_->joined && jobs_.kind() != Kind::kUpdate;
  show_scene(*scene_, new_input ? ShownAs::kNew : ShownAs::kChanged, view_);
  bool overtaken = false;
  if (new_input) {
    plot_.forget();
    // What is so of the input at all waits behind a button; what warns, or comes up later, is a banner.
    state_.closed_notes = {scene_->notes.begin(), scene_->notes.end()};
    state_.closed_notes.insert(scene_->volume_notes.begin(), scene_->volume_notes.end());
    std::erase_if(state_.closed_notes,
                  [](const std::string& note) { return note.find("WARNING") != std::string::npos; });
    state_.closed_notes.erase(scene_->memory_note);  // lines are missing
    for (const auto* notes : {&scene_->notes, &scene_->volume_notes}) {
      for (const std::string& note : *notes) state_.log.add(note, false);
    }
    controls_.menu().hide();
    start_asked_ = false;
    shown_ = true;
    if (jobs_.kind() == Kind::kOpen) {
      forget_input();
      angles_ = options_.angles;
      const std::vector<std::string>& plotted = scene_->info->plotted;
      if (std::ranges::find(plotted, state_.plotted) == plotted.end()) state_.plotted.clear();
    }
    // Edits made while the input was being read belonged to the old one.
    state_.document = scene_->document;
    needs_camera_ = true;
    edits_.forget();
    remember(state_.recent, scene_->info->files);
    glfwSetWindowTitle(glfw_.get(), (scene_->info->name + " - " + options_.program).c_str());
  } else if (scene_->joined) {
    state_.document = scene_->document;
  } else if (same_scene(state_.document, jobs_.requested())) {
    // What the panel has been set to meanwhile stays; what was left to a default is now known.
    take_scene(scene_->document, state_.document);
  } else {
    overtaken = true;
  }
  // What a scene leaves out of its document is not asked for again and again.
  jobs_.settle(overtaken ? scene_->document : state_.document);
  state_.seeds = seed_choice(state_.document.tracing.seeds);
  adopt_field();
  if (new_input && jobs_.kind() == Kind::kOpen && !scene_->document.common.session.empty()) restore_session();
  edits_.keep();
  // Defaults that are known now are no edit.
  if (settled && !scene_->joined) edits_.settle();
  if (new_input) state_.lines_file = touch_.data().has_tensors() ? "tracts.tck" : PanelState{}.lines_file;
  if (new_input || state_.message == kCancelled) state_.say({});
  if (new_input || state_.error_of_job) state_.error.clear();
}

void ExplorerWindow::forget_input() {
  controls_.forget_region();
  controls_.touch().mark(false);
  touch_.forget();
  files_.note_opened({});
  cuts_.forget();
}

void ExplorerWindow::restore_session() {
  const Document& document = scene_->document;
  files_.note_opened(document.common.session);
  state_.play_rate = document.view.play_rate;
  state_.plotted = document.series.plot;
  try {
    apply_appearance(document, view_);
    angles_ = camera_angles(document.view.camera);
    focal_point_ = focal_point_of(document.view);
    edits_.put_region(document.slice.box);
    if (!touch_.available()) return;
    touch_.restore(document.touch);
    if (document.touch.drawn_lines.empty()) return;
    HandMade made = touch_.trail().made();
    made.kept = read_drawn_lines(document.touch.drawn_lines);
    touch_.trail().put(made);
    files_.note_opened(document.common.session);
  } catch (const Error& error) {
    state_.fail(error.what());
  }
}

void ExplorerWindow::keep_thumbnail() {
  if (scene_ && !scene_->info->files.files.empty() && frame_ > 0)
    thumbnails_->keep(scene_->info->files, picture_->read(view_.background));
}

void ExplorerWindow::close_data() {
  jobs_.close();
  start_asked_ = false;
  if (!scene_) return;
  keep_thumbnail();
  let_go();
  controls_.menu().hide();
  touch_.close_field();
  forget_input();
  plot_.forget();
  edits_.forget();
  scene_.reset();
  SceneView empty = options_.view;
  empty.background = view_.background;
  empty.stereo = view_.stereo;
  view_ = std::move(empty);
  needs_camera_ = true;
  state_.say({});
  state_.error.clear();
  picture_->live().damage();
  glfwSetWindowTitle(glfw_.get(), options_.program.c_str());
}

void ExplorerWindow::adopt_field() {
  NamedField open{.field = scene_->probed, .name = {}, .scalar = scene_->haptic_scalar};
  open.tensor = scene_->tensors ? scene_->tensors->image->field : scene_->haptic_tensor;
  if (open.empty()) {
    controls_.touch().let_go();
    touch_.close_field();
    return;
  }
  // The fields of all examples have the same label.
  const SceneInfo& info = *scene_->info;
  std::string label = scene_->document.input.field;
  if (info.files.files.empty()) label.insert(0, info.name + " ");
  open.name = field_key(label, time_step_of(scene_->document, info.times)) + scene_->haptic_scalar_key;
  if (touch_.set_field(std::move(open))) controls_.touch().let_go();
  if (!touch_.available()) return;
  if (!view_.probe) view_.probe.emplace();
  view_.probe->reference_speed = reference_speed(view_);
}

void ExplorerWindow::fail(const std::exception_ptr& error) {
  using Kind = SceneJobs::Kind;
  if (jobs_.kind() == Kind::kStart) std::rethrow_exception(error);
  if (jobs_.kind() == Kind::kOpen) jobs_.forget_beside();
  if (jobs_.kind() == Kind::kUpdate) {
    const bool overtaken = !same_scene(state_.document, jobs_.requested());
    jobs_.settle(scene_->document);
    // What has been edited meanwhile stays, and is asked for next.
    if (overtaken) return;
    // What was open stays; so does the document that made it.
    state_.document = scene_->document;
    edits_.fail();
    state_.seeds = seed_choice(state_.document.tracing.seeds);
    state_.playing = false;
  }
  try {
    std::rethrow_exception(error);
  } catch (const Cancelled&) {
    state_.say(kCancelled);
  } catch (const std::exception& e) {
    std::vector<std::string> series = asked_series(e.what());
    if (jobs_.kind() != Kind::kOpen || series.empty()) {
      state_.fail(e.what(), true);
    } else {
      series_choice_.ask(jobs_.opened(), std::move(series));
    }
  }
}

void ExplorerWindow::follow_layer() {
  const ProbeReadout& hand = touch_.readout();
  if (!scene_ || !scene_->info->layers || !hand.held || !hand.scalar) return;
  if (const auto level = haptic_level(touch_.data().levels(), *hand.scalar))
    state_.document.heart.layer = exact_number(*level);
}

}  // namespace palpate
