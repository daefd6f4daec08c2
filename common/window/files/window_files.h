/// What a window writes on request, and what is asked before lines or tracts are forgotten that are in no
/// file.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "common/geometry/annotation.h"
#include "common/hand/probe_session.h"
#include "common/window/files/saved_files.h"
#include "common/window/panels/panel.h"
#include "common/window/panels/unsaved_question.h"

namespace palpate {

class WindowFiles {
 public:
  /// `touch`, whose lines at the start are in a file, and `state`, in which messages are left, outlive it.
  WindowFiles(const std::filesystem::path& folder, const std::string& program, ProbeSession& touch,
              PanelState& state)
      : program_(program), saved_(folder, program), touch_(touch), state_(state) {
    note_opened();
  }

  /// What is there now is in a file: another input has been opened.
  void note_opened() {
    saved_.note_saved(touch_.trail().drawn_lines());
    saved_notes_ = touch_.notes().entries();
  }

  /// Says what `save` wrote, or why it did not. @return whether it did.
  bool attempt(const std::function<std::string()>& save);
  /// Saves the lines or tracts that are kept, those that are drawn and not kept yet too.
  void save_lines();
  /// Saves the session of `document`, and beside it the lines or tracts, likewise.
  void save_session(WindowModel& model, Document document);
  void save_picture(const Image& image, const std::vector<PngText>& texts);
  /// The files that the panels have a button for.
  void save_asked(const PanelActions& actions, const SceneView& view, const std::optional<Box>& region);

  /// Asks what to do with lines, tracts and annotations that are in no file. @param opens in place of closing the window.
  /// @return false where there are none.
  bool ask(std::optional<InputFiles> opens);
  [[nodiscard]] bool asking() const noexcept { return question_.asking(); }
  /// Whether the event was for the question.
  bool handle(const InputEvent& event) { return question_.handle(event); }
  /// What was answered: lines are saved, or may be forgotten.
  struct Leave {
    std::optional<InputFiles> opens;  ///< none: the window closes
  };
  /// Once a frame, drawing the question. @return what goes on; none where nothing was answered, or not that.
  [[nodiscard]] std::optional<Leave> answer();

 private:
  /// Those that are kept, after keeping those that are drawn.
  const DrawnLines& all_lines();
  std::string write_lines();
  std::string write_notes(const std::string& ending);
  [[nodiscard]] std::size_t unsaved_lines() const;
  [[nodiscard]] std::size_t unsaved_notes() const;

  std::string program_;
  SavedFiles saved_;
  std::vector<Annotation> saved_notes_;
  UnsavedQuestion question_;
  ProbeSession& touch_;
  PanelState& state_;
};

}  // namespace palpate
