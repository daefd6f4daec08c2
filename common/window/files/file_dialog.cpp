#include "common/window/files/file_dialog.h"

#include <algorithm>
#include <cstdlib>
#include <utility>

#include <imgui.h>

#include "common/base/index.h"
#include "common/window/panels/panel_parts.h"

namespace palpate {
namespace {

constexpr const char* kId = "###files";
constexpr int kPage = 10;  // rows

}  // namespace

void FileDialog::ask(FileRequest request) {
  request_ = std::move(request);
  all_ = accepts_ = cancels_ = false;
  replaces_.clear();
  go_to(request_->folder);
  clear_typed(request_->name);
}

void FileDialog::go_to(const std::filesystem::path& folder) {
  std::error_code error;
  const std::filesystem::path before = std::exchange(folder_, std::filesystem::absolute(folder, error));
  folder_ = folder_.lexically_normal();
  if (!folder_.has_filename() && folder_.has_relative_path()) folder_ = folder_.parent_path();  // "a/"
  marked_.clear();
  current_.clear();
  list();
  // From above one sees where one has been.
  if (before.parent_path() == folder_ && before != folder_) current_ = before.filename().string();
  shows_current_ = true;
  if (!request_->writes) clear_typed();
}

void FileDialog::list() {
  const FileFilter everything = [this](const std::filesystem::path& path, bool folder) {
    return !folder || (!request_->writes && request_->shows(path, true));
  };
  list_ =
      list_folder(folder_, all_ ? everything : request_->shows, !request_->writes && typed_.starts_with('.'));
}

void FileDialog::clear_typed(std::string text) {
  typed_ = typed_before_ = std::move(text);
  on_list_ = false;
  notice_.clear();
  takes_focus_ = true;
  ++field_;
}

std::vector<std::size_t> FileDialog::seen() const {
  std::vector<std::size_t> places;
  const bool narrowed = !request_->writes && !typed_.empty() && typed_.find('/') == std::string::npos;
  for (std::size_t i = 0; i < list_.entries.size(); ++i) {
    if (!narrowed || on_list_ || matches(list_.entries[i].name, typed_)) places.push_back(i);
  }
  return places;
}

void FileDialog::move(int by) {
  const std::vector<std::size_t> places = seen();
  if (places.empty()) return;
  const auto now =
      std::ranges::find_if(places, [&](std::size_t place) { return list_.entries[place].name == current_; });
  const int last = static_cast<int>(places.size()) - 1;
  const int from = now == places.end() ? (by > 0 ? -1 : last + 1) : static_cast<int>(now - places.begin());
  const FolderEntry& entry = list_.entries[places[as_size(std::clamp(from + by, 0, last))]];
  current_ = entry.name;
  shows_current_ = true;
  replaces_.clear();
  if (request_->writes && !entry.folder) clear_typed(entry.name);
  on_list_ = request_->writes;
}

bool FileDialog::handle(const InputEvent& event) {
  if (!asking()) return false;
  if (event.kind == InputKind::kKeyDown) {
    const auto entry =
        std::ranges::find_if(list_.entries, [&](const FolderEntry& e) { return e.name == current_; });
    const bool on_entry = entry != list_.entries.end();
    switch (event.key) {
      case key_code::kEscape:
        cancels_ = true;
        break;
      case key_code::kEnter:
      case key_code::kPadEnter:
        accepts_ = true;
        break;
      case key_code::kDown:
      case key_code::kUp:
        move(event.key == key_code::kDown ? 1 : -1);
        break;
      case key_code::kPageDown:
      case key_code::kPageUp:
        move(event.key == key_code::kPageDown ? kPage : -kPage);
        break;
      case key_code::kBackspace:
      case key_code::kLeft:
        if (typed_.empty()) go_to(folder_.parent_path());
        break;
      case key_code::kRight:
        if (typed_.empty() && on_entry && entry->folder) go_to(folder_ / std::string(entry->name));
        break;
      case key_code::kInsert:
        if (on_entry && entry->offered && !request_->writes && marked_.erase(current_) == 0)
          marked_.insert(current_);
        break;
      default:
        break;
    }
    return true;
  }
  return event.kind == InputKind::kKeyUp || event.kind == InputKind::kText ||
         event.kind == InputKind::kPress || event.kind == InputKind::kWheel || event.kind == InputKind::kDrop;
}

std::filesystem::path FileDialog::typed_path() const {
  std::filesystem::path path = typed_;
  const char* const home = std::getenv("HOME");  // NOLINT(concurrency-mt-unsafe): read only
  if (home != nullptr && (typed_ == "~" || typed_.starts_with("~/")))
    path = std::filesystem::path(home) / typed_.substr(std::min<std::size_t>(2, typed_.size()));
  return (folder_ / path).lexically_normal();
}

void FileDialog::follow_typed() {
  std::error_code unknown;
  if (!typed_.ends_with('/') || !std::filesystem::is_directory(typed_path(), unknown)) return;
  const std::filesystem::path folder = typed_path();
  clear_typed();
  go_to(folder);
}

void FileDialog::handle_typing() {
  if (typed_ == typed_before_) return;
  const bool hidden = typed_.starts_with('.') != typed_before_.starts_with('.');
  typed_before_ = typed_;
  on_list_ = false;
  notice_.clear();
  replaces_.clear();
  if (hidden) list();
  if (!request_->writes) {
    const std::vector<std::size_t> places = seen();
    current_ = places.empty() || typed_.empty() ? std::string() : list_.entries[places.front()].name;
    shows_current_ = true;
  }
  follow_typed();
}

std::optional<FileDialog::Paths> FileDialog::accept_entry(const FolderEntry& entry) {
  const std::filesystem::path path = folder_ / entry.name;
  if (entry.folder && (!entry.offered || request_->writes)) {
    go_to(path);
    return std::nullopt;
  }
  return Paths{path};
}

std::optional<FileDialog::Paths> FileDialog::accept_written() {
  std::error_code unknown;
  if (typed_.empty()) {
    notice_ = "type a name";
    return std::nullopt;
  }
  std::filesystem::path path = typed_path();
  if (std::filesystem::is_directory(path, unknown)) {
    go_to(path);
    return std::nullopt;
  }
  if (!path.filename().string().ends_with(request_->ending)) path += request_->ending;
  if (!std::filesystem::is_directory(path.parent_path(), unknown)) {
    notice_ = path.parent_path().string() + " is no folder";
    return std::nullopt;
  }
  if (std::filesystem::exists(path, unknown) && replaces_ != path) {
    replaces_ = path;
    notice_ = path.filename().string() + " is there already: press Enter again to write over it";
    return std::nullopt;
  }
  return Paths{path};
}

std::optional<FileDialog::Paths> FileDialog::accept() {
  const auto entry =
      std::ranges::find_if(list_.entries, [&](const FolderEntry& e) { return e.name == current_; });
  const bool on_entry = entry != list_.entries.end();
  if (request_->writes) {
    if (on_list_ && on_entry && entry->folder) return accept_entry(FolderEntry(*entry));
    return accept_written();
  }
  if (!marked_.empty()) {
    Paths paths;
    for (const std::string& name : marked_) paths.push_back(folder_ / name);
    return paths;
  }
  std::error_code unknown;
  if (typed_.find('/') != std::string::npos && std::filesystem::exists(typed_path(), unknown)) {
    if (!std::filesystem::is_directory(typed_path(), unknown)) return Paths{typed_path()};
    go_to(typed_path());
    return std::nullopt;
  }
  if (on_entry) return accept_entry(FolderEntry(*entry));
  if (typed_.empty() && request_->shows && request_->shows(folder_, true)) return Paths{folder_};
  notice_ = typed_.empty() ? "choose a file" : "nothing here is called " + typed_;
  return std::nullopt;
}

void FileDialog::draw_place() {
  const float em = ImGui::GetFontSize();
  if (button("Up", {4.0F * em, 0.0F})) go_to(folder_.parent_path());
  hint("the folder above (Backspace in an empty field)");
  ImGui::SameLine();
  if (button("Home", {4.0F * em, 0.0F})) go_to(documents_folder());
  hint("the folder of your documents");
  ImGui::SameLine();
  // Its end says more than its beginning.
  std::string place = folder_.string();
  const float room = ImGui::GetContentRegionAvail().x;
  while (ImGui::CalcTextSize(place.c_str()).x > room) {
    const std::size_t next = place.find('/', place.starts_with("…/") ? std::string("…/").size() : 1);
    if (next == std::string::npos) break;
    place = "…" + place.substr(next);
  }
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted(place.c_str());
  hint("%s", folder_.c_str());
}

void FileDialog::draw_entry(std::size_t place) {
  const FolderEntry entry = list_.entries[place];
  const std::string label = entry.name + (entry.folder ? "/" : "");
  const bool current = entry.name == current_ || marked_.contains(entry.name);
  if (selectable(label.c_str(), current, ImGuiSelectableFlags_AllowDoubleClick)) {
    if (!request_->writes && entry.offered && ImGui::GetIO().KeyCtrl) {
      if (marked_.empty() && !current_.empty() && current_ != entry.name) marked_.insert(current_);
      if (marked_.erase(entry.name) == 0) marked_.insert(entry.name);
    } else {
      marked_.clear();
    }
    current_ = entry.name;
    replaces_.clear();
    if (request_->writes && !entry.folder) clear_typed(entry.name);
    on_list_ = request_->writes;
    if (ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left)) accepts_ = true;
    takes_focus_ = true;
  }
  if (entry.folder && entry.offered) hint("can be opened as a whole; Right, or 'Go into', goes into it");
  if (shows_current_ && entry.name == current_) {
    ImGui::SetScrollHereY();
    shows_current_ = false;
  }
}

void FileDialog::draw_entries(float foot) {
  ImGui::BeginChild("##entries", {0.0F, -foot}, true);
  if (!list_.error.empty()) ImGui::TextWrapped("%s", list_.error.c_str());
  const std::vector<std::size_t> places = seen();
  if (list_.error.empty() && places.empty()) {
    ImGui::TextDisabled(
        "%s", list_.entries.empty() ? "nothing here that can be opened" : "nothing here is called so");
  }
  for (const std::size_t place : places) {
    if (place < list_.entries.size()) draw_entry(place);
  }
  ImGui::EndChild();
}

bool FileDialog::draw_buttons() {
  const float em = ImGui::GetFontSize();
  const ImVec2 size{8.0F * em, 0.0F};
  if (!request_->writes) {
    if (checkbox("all files", &all_)) list();
    hint("also those whose names say that they cannot be opened here");
    const auto entry =
        std::ranges::find_if(list_.entries, [&](const FolderEntry& e) { return e.name == current_; });
    if (entry != list_.entries.end() && entry->folder && entry->offered) {
      ImGui::SameLine();
      if (button("Go into")) go_to(folder_ / std::string(entry->name));
      hint("the folder, which double clicks and Open take as a whole");
    }
    ImGui::SameLine();
  }
  const float left = ImGui::GetWindowContentRegionMax().x - 2.0F * size.x - ImGui::GetStyle().ItemSpacing.x;
  ImGui::SetCursorPosX(std::max(left, ImGui::GetCursorPosX()));
  const bool asked = button(replaces_.empty() ? request_->button.c_str() : "Replace", size);
  ImGui::SameLine();
  cancels_ |= button("Cancel", size);
  return asked;
}

std::optional<FileDialog::Paths> FileDialog::draw() {
  if (!asking()) return std::nullopt;
  if (!ImGui::IsPopupOpen(kId)) ImGui::OpenPopup(kId);
  constexpr float kWidth = 46.0F, kHeight = 36.0F;  // heights of the text
  const float em = ImGui::GetFontSize();
  const ImVec2 window = ImGui::GetIO().DisplaySize;
  center_next_window();
  ImGui::SetNextWindowSize(
      {std::min(kWidth * em, window.x - 2.0F * em), std::min(kHeight * em, window.y - 2.0F * em)});
  constexpr ImGuiWindowFlags kFlags =
      ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings;
  std::optional<Paths> chosen;
  if (ImGui::BeginPopupModal(kId, nullptr, kFlags)) {
    ImGui::TextUnformatted(request_->title.c_str());
    ImGui::Separator();
    draw_place();
    const float row = ImGui::GetFrameHeightWithSpacing();
    draw_entries((request_->more ? 5.0F : 3.0F) * row + 0.3F * em);
    ImGui::PushID(field_);
    ImGui::SetNextItemWidth(-8.0F * em);
    if (takes_focus_) ImGui::SetKeyboardFocusHere();
    takes_focus_ = false;
    (void)input_text(request_->writes ? "file name" : "name or path", &typed_,
                     request_->writes ? ImGuiInputTextFlags_AutoSelectAll : 0);
    ImGui::PopID();
    handle_typing();
    ImGui::TextDisabled("%s", notice_.empty() ? (request_->writes ? "Enter saves, Esc leaves"
                                                                  : "Enter opens, Insert or Ctrl+click marks "
                                                                    "several, Esc leaves")
                                              : notice_.c_str());
    if (request_->more) request_->more();
    if (draw_buttons()) accepts_ = true;
    if (std::exchange(accepts_, false) && !cancels_) {
      chosen = accept();
      takes_focus_ = true;  // Enter leaves the field
    }
    if (chosen || cancels_) ImGui::CloseCurrentPopup();
    ImGui::EndPopup();
  }
  if (chosen || std::exchange(cancels_, false)) request_.reset();
  return chosen;
}

}  // namespace palpate
