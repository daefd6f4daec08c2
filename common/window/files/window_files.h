/// What a window writes on request and where, what it is asked to open, and what is asked before lines or tracts
/// are forgotten that are in no file.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "common/geometry/annotation.h"
#include "common/hand/probe_session.h"
#include "common/scene/document/field_kind.h"
#include "common/window/files/file_dialog.h"
#include "common/window/files/picture_export.h"
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
    note_opened({});
  }

  /// What is there now is in a file: another input has been opened.
  /// @param session that it was opened by; empty: none.
  void note_opened(const std::filesystem::path& session) {
    saved_.note_saved(touch_.trail().drawn_lines());
    saved_notes_ = touch_.notes().entries();
    session_ = session;
  }

  /// Asks which files to open.
  void ask_to_open(FieldKind kind);
  /// Asks where to save the session of `document`, proposing the user's folder.
  void ask_for_session(const Document& document);
  /// Asks for the size, the background and the name of a picture. @param width, height of the one that is seen.
  void ask_for_picture(int width, int height);
  /// Has `view` drawn into `file`, as was chosen in that dialog.
  void export_picture(SceneView view, const std::filesystem::path& file, std::vector<PngText> texts);
  /// Once a frame: says what became of it. @return whether it was drawn, after which no OpenGL context is current.
  bool follow_export();
  /// The session that is saved again without asking; empty: none is yet.
  [[nodiscard]] const std::filesystem::path& session() const noexcept { return session_; }
  /// What was chosen in a dialog.
  struct Chosen {
    enum class What : std::uint8_t { kOpen, kSession, kPicture };
    What what = What::kOpen;
    std::vector<std::filesystem::path> files;  ///< one, but for those to open
  };
  /// Once a frame, drawing the dialog. @return what was chosen in it.
  [[nodiscard]] std::optional<Chosen> chosen();

  /// Says what `save` wrote, or why it did not. @return whether it did.
  bool attempt(const std::function<std::string()>& save);
  /// Saves the lines or tracts that are kept, those that are drawn and not kept yet too.
  void save_lines();
  /// Saves the session of `document` to `file`, and beside it the lines or tracts, likewise.
  void save_session(WindowModel& model, Document document, const std::filesystem::path& file);
  void save_picture(const Image& image, const std::vector<PngText>& texts);
  /// The files that the panels have a button for.
  void save_asked(const PanelActions& actions, const SceneView& view, const std::optional<Box>& region);

  /// Asks what to do with lines, tracts and annotations that are in no file. @return false where there are none.
  bool ask(const Leaving& leaving);
  /// Whether a question or a dialog waits for an answer.
  [[nodiscard]] bool asking() const noexcept { return question_.asking() || dialog_.asking(); }
  /// Whether the event was for that.
  bool handle(const InputEvent& event) { return question_.handle(event) || dialog_.handle(event); }
  /// Once a frame, drawing the question. @return what goes on, for lines are saved or may be forgotten; none where
  /// nothing was answered, or not that.
  [[nodiscard]] std::optional<Leaving> answer();

 private:
  /// Those that are kept, after keeping those that are drawn.
  const DrawnLines& all_lines();
  std::string write_lines();
  std::string write_notes(const std::string& ending);
  [[nodiscard]] std::size_t unsaved_lines() const;
  [[nodiscard]] std::size_t unsaved_notes() const;

  std::string program_;
  SavedFiles saved_;
  FileDialog dialog_;
  Chosen::What asked_ = Chosen::What::kOpen;      // of the dialog
  std::filesystem::path opened_from_, saved_to_;  // folders that the user has chosen; empty: none yet
  std::filesystem::path pictures_to_;
  std::filesystem::path session_;
  PictureExport picture_;
  std::vector<Annotation> saved_notes_;
  UnsavedQuestion question_;
  ProbeSession& touch_;
  PanelState& state_;
};

}  // namespace palpate
