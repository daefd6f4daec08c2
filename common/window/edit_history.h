/// What the user has edited in a window: the document follows what mouse, hand and panels do to the picture, and each
/// edit is a step that is taken back and restored. A drag is one step; where one looks from is none.
#pragma once

#include <optional>
#include <string>

#include "common/base/history.h"
#include "common/compose/window_model.h"
#include "common/hand/probe_session.h"
#include "common/window/controls/plane_cuts.h"
#include "common/window/controls/scene_controls.h"
#include "common/window/panels/panel.h"
#include "common/window/shown_scene.h"

namespace palpate {

class EditHistory {
 public:
  /// What edits change; outlives it.
  struct Parts {
    const WindowModel& model;
    PanelState& state;  ///< with the document
    SceneView& view;
    const std::optional<SceneState>& scene;
    const bool& needs_camera;  ///< the view has none yet: nothing of it is kept
    ProbeSession& touch;
    SceneControls& controls;
    PlaneCuts& cuts;
  };
  explicit EditHistory(const Parts& parts) : on_(parts) {}

  /// What is shown goes into the document.
  void keep();
  /// Once a frame: and what the user did into the steps. They begin with the first picture of an input.
  void follow();
  /// Another input: no step leads back to the one before.
  void forget();
  /// Whether nothing was done since the last step.
  [[nodiscard]] bool settled() const { return history_ && edited() == history_->now(); }
  /// It is as it is without an edit: a default is known now.
  void settle();
  /// The last edit has come to nothing: the document is what it was before.
  void fail();

  /// Takes back the last edit, or restores the last that was taken back; what goes on is an edit up to now.
  /// @return what to tell the user.
  [[nodiscard]] std::string undo();
  [[nodiscard]] std::string redo();
  /// Gives a setting its default, whose control cannot do so itself. @return what to tell the user. @pre a scene.
  [[nodiscard]] std::string reset(const std::string& setting);
  /// @param box in words; empty: no region of interest.
  void put_region(const std::string& box);

 private:
  /// What edits are of: the document but for the camera, whose moves are none, and what the hand has made.
  struct Edited {
    Document document;
    HandMade made;
    ViewEdits view;

    bool operator==(const Edited& other) const { return document == other.document && made == other.made; }
  };
  [[nodiscard]] Edited edited() const;
  /// Something goes on that is one edit when it ends.
  [[nodiscard]] bool dragging() const;
  /// Shows `to` in place of what is shown, from where it is seen now.
  void restore(const Edited& to);

  Parts on_;
  SceneView kept_;  // that the document was kept of last
  std::optional<History<Edited>> history_;
};

}  // namespace palpate
