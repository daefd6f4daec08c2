/// The dialog that asks for a file to be opened or written, drawn with Dear ImGui like the panels.
///
/// It is no dialog of the desktop (a portal, GTK): those need a session bus and a desktop on the machine that the
/// program runs on, which a remote display, a container or a plain window manager does not have; and no test could
/// type into them. This one works wherever the window does.
///
/// The keyboard alone suffices: what is typed finds names, or is a path; Up and Down choose, Enter opens or goes
/// into a folder, Backspace and Left in an empty field go up, Right goes into a folder that could be opened as a
/// whole, Insert marks one of several, Esc leaves.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "common/window/files/folder_list.h"
#include "common/window/input_event.h"

namespace palpate {

/// What is asked for.
struct FileRequest {
  std::string title;
  std::string button = "Open";
  bool writes = false;              ///< one file, that may not be there yet; else some that are
  std::filesystem::path folder;     ///< where it begins
  std::string name = {};            ///< proposed
  std::string ending = {};          ///< what is written ends with this: added where it is missing
  FileFilter shows;                 ///< files that are listed until the user asks for all
  std::function<void()> more = {};  ///< draws more controls above the buttons; may be empty
};

class FileDialog {
 public:
  using Paths = std::vector<std::filesystem::path>;

  void ask(FileRequest request);
  [[nodiscard]] bool asking() const noexcept { return request_.has_value(); }
  /// Where it is, or was last.
  [[nodiscard]] const std::filesystem::path& folder() const noexcept { return folder_; }

  /// While it asks, keys, presses and dropped files are not for the picture. @return whether it took the event.
  bool handle(const InputEvent& event);
  /// Once a frame, in the middle of the window. @return absolute paths, once they are chosen, which ends it.
  [[nodiscard]] std::optional<Paths> draw();

 private:
  void go_to(const std::filesystem::path& folder);
  void list();
  void clear_typed(std::string text = {});
  /// Those that are seen, by their places in the list.
  [[nodiscard]] std::vector<std::size_t> seen() const;
  void move(int by);
  /// Goes where what is typed leads, once it ends with '/'.
  void follow_typed();
  void handle_typing();
  /// What Enter or the button means. @return what is chosen by it.
  std::optional<Paths> accept();
  std::optional<Paths> accept_written();
  std::optional<Paths> accept_entry(const FolderEntry& entry);
  [[nodiscard]] std::filesystem::path typed_path() const;
  void draw_place();
  void draw_entries(float foot);
  void draw_entry(std::size_t entry);
  [[nodiscard]] bool draw_buttons();

  std::optional<FileRequest> request_;
  std::filesystem::path folder_;
  FolderList list_;
  std::string typed_, typed_before_;
  std::set<std::string> marked_;    // names of several
  std::string current_;             // name of the entry that Enter opens; empty: none
  std::string notice_;              // why Enter did nothing
  std::filesystem::path replaces_;  // that the user has been asked about
  bool all_ = false;                // files of any kind
  bool on_list_ = false;            // the keyboard went through the list since something was typed
  bool accepts_ = false, cancels_ = false, shows_current_ = false, takes_focus_ = false;
  int field_ = 0;  // another one each time its text is changed by others than the user
};

}  // namespace palpate
