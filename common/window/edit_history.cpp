#include "common/window/edit_history.h"

#include <imgui.h>

#include "common/compose/appearance.h"
#include "common/compose/line_view.h"
#include "common/compose/slice_plane.h"
#include "common/compose/text/slice_panes_text.h"

namespace palpate {
namespace {

/// Panes as they are set, seen from where `from` is: where one looks is no edit.
PanesOptions looked_at(PanesOptions panes, const PanesOptions& from) {
  panes.cross = from.cross;
  panes.turn = from.turn;
  panes.center = from.center;
  panes.zoom = from.zoom;
  return panes;
}

}  // namespace

void EditHistory::put_region(const std::string& box) {
  on_.controls.region().put(box.empty() ? std::nullopt : std::optional(parse_box(box, "--box")));
}

void EditHistory::keep() {
  if (!on_.scene || on_.needs_camera) return;
  Document& document = on_.state.document;
  if (!same_picture(on_.view, kept_) || on_.view.aspect != kept_.aspect) {
    on_.model.keep(on_.view, document);
    kept_ = on_.view;
  }
  const auto& box = on_.controls.region().box();
  const bool has_region = on_.view.volume && on_.scene->is_volume_alone();
  document.slice.box = box && has_region ? box_text(*box) : std::string();
  document.series.plot = on_.state.plotted;
  document.view.play_rate = on_.state.play_rate;
  on_.touch.keep(document.touch);
}

bool EditHistory::dragging() const {
  const auto& planes = on_.touch.planes();
  const bool plane = planes && planes->state != WidgetState::kFree && on_.touch.readout().acts;
  // Time that plays, and layers that the hand goes through, are one edit each.
  const bool layers = on_.scene && on_.scene->info->layers && on_.touch.readout().held;
  return on_.state.playing || plane || layers || !on_.controls.resting() || ImGui::IsAnyItemActive();
}

EditHistory::Edited EditHistory::edited() const {
  Edited now{.document = on_.state.document, .made = on_.touch.trail().made(), .view = edits_of(on_.view)};
  now.document.view.camera.clear();
  now.document.view.focal.clear();
  now.document.panes = looked_at(now.document.panes, {});
  return now;
}

void EditHistory::follow() {
  if (!on_.scene || on_.needs_camera) return;
  keep();
  if (!history_) {
    history_.emplace(edited());
  } else if (history_->now().document.touch.planes.planes.empty() &&
             !on_.state.document.touch.planes.planes.empty()) {
    history_->settle(edited());  // planes that a mode begins with are no edit
  } else if (!dragging()) {
    history_->push(edited());
  }
}

void EditHistory::forget() {
  history_.reset();
  kept_ = {};
}

void EditHistory::settle() {
  if (history_) history_->settle(edited());
}

void EditHistory::fail() {
  on_.model.keep(on_.view, on_.state.document);
  keep();
  if (history_) history_->fail(edited());
}

std::string EditHistory::undo() {
  // A point of what is being marked is in no document yet.
  if (on_.controls.touch().marking() && on_.touch.notes().take_back()) return "undone";
  keep();
  if (history_) history_->push(edited());
  if (!history_ || !history_->can_undo()) return "nothing to undo";
  restore(history_->undo());
  return "undone";
}

std::string EditHistory::redo() {
  keep();
  if (history_) history_->push(edited());
  if (!history_ || !history_->can_redo()) return "nothing to restore";
  restore(history_->redo());
  return "restored";
}

void EditHistory::restore(const Edited& to) {
  Document& document = on_.state.document;
  const ViewOptions seen = document.view;
  const PanesOptions seen_panes = document.panes;
  document = to.document;
  document.view.camera = seen.camera;
  document.view.focal = seen.focal;
  document.panes = looked_at(to.document.panes, seen_panes);
  on_.state.seeds = seed_choice(to.document.tracing.seeds);
  on_.state.plotted = to.document.series.plot;
  on_.state.play_rate = to.document.view.play_rate;
  apply_appearance(to.document, on_.view);
  put_edits(to.view, *on_.scene, on_.view);
  if (on_.view.volume)
    on_.view.volume->panes = slice_panes_of(document.panes, on_.view.volume->image->bounds());
  put_region(to.document.slice.box);
  on_.touch.restore(to.document.touch);
  on_.cuts.restored(on_.touch);
  on_.touch.trail().put(to.made);
  // What the document says in other words now is no edit.
  keep();
  settle();
}

std::string EditHistory::reset(const std::string& name) {
  keep();
  Document with = on_.state.document;
  const FieldKind kind = with.input.kind;
  const Setting* const row = find_setting(name, kind) != nullptr ? find_setting(name, kind) : &setting(name);
  set_value(*row, with, default_text(*row));
  apply_appearance(with, on_.view);
  if (on_.view.volume) {
    on_.view.volume->panes = slice_panes_of(with.panes, on_.view.volume->image->bounds());
    if (name == "window" || name == "level") on_.view.volume->planes.window.reset();
  }
  if (on_.touch.available()) on_.touch.restore(with.touch);
  put_region(with.slice.box);
  on_.state.document = with;
  on_.state.seeds = seed_choice(with.tracing.seeds);
  return row->label() +
         " is as in the beginning: " + (default_text(*row).empty() ? "as found" : default_text(*row));
}

}  // namespace palpate
