#include "common/window/files/window_files.h"

#include <algorithm>
#include <cstddef>
#include <exception>
#include <utility>

#include "common/base/error.h"
#include "common/base/index.h"
#include "common/base/text.h"
#include "common/scene/session_of.h"

namespace palpate {

void WindowFiles::export_picture(SceneView view, const std::filesystem::path& file,
                                 std::vector<PngText> texts) {
  picture_.ask(std::move(view), file, std::move(texts));
  state_.say("drawing " + file.string() + " …");
}

bool WindowFiles::follow_export() {
  const auto outcome = picture_.take();
  if (!outcome) return false;
  if (outcome->done) {
    state_.say("saved " + outcome->words);
  } else {
    state_.fail(outcome->words);
  }
  return true;
}

bool WindowFiles::attempt(const std::function<std::string()>& save) {
  try {
    state_.say("saved " + save());
    return true;
  } catch (const std::exception& error) {
    state_.fail(error.what());
    return false;
  }
}

const DrawnLines& WindowFiles::all_lines() {
  if (!touch_.trail().drawn().empty()) (void)touch_.trail().keep_line();
  return touch_.trail().drawn_lines();
}

std::string WindowFiles::write_lines() {
  const DrawnLines& lines = all_lines();
  if (lines.entries().empty())
    throw work_error(touch_.data().has_tensors() ? "no tract is drawn; press G, then drag along one"
                                                 : "no line is kept; grab the probe (G), then K keeps one");
  return saved_.save_lines(lines, state_.lines_file).string();
}

void WindowFiles::ask_to_open(FieldKind kind) {
  std::filesystem::path from = opened_from_;
  if (from.empty() && state_.scene != nullptr && !state_.scene->info->files.files.empty())
    from = state_.scene->info->files.files.front().parent_path();
  if (from.empty() && !state_.recent.empty()) from = state_.recent.front().files.front().parent_path();
  std::error_code unknown;
  if (!std::filesystem::is_directory(from, unknown)) from = std::filesystem::current_path(unknown);
  asked_ = Chosen::What::kOpen;
  dialog_.ask({.title = "Open data, or a session",
               .folder = from,
               .shows = [kind](const std::filesystem::path& path, bool folder) {
                 return can_open(path, folder, kind);
               }});
}

void WindowFiles::ask_for_session(const Document& document) {
  std::filesystem::path to = saved_to_;
  if (to.empty()) to = session_.empty() ? documents_folder() : session_.parent_path();
  asked_ = Chosen::What::kSession;
  dialog_.ask({.title = "Save the session as",
               .button = "Save",
               .writes = true,
               .folder = to,
               .name = session_.empty() ? session_name(document, program_) : session_.filename().string(),
               .ending = std::string(kSessionEnding),
               .shows = [](const std::filesystem::path& path, bool folder) {
                 return !folder && path.filename().string().ends_with(kSessionEnding);
               }});
}

void WindowFiles::ask_for_picture(int width, int height) {
  picture_.begin(width, height);
  asked_ = Chosen::What::kPicture;
  const std::filesystem::path to = pictures_to_.empty() ? documents_folder() : pictures_to_;
  std::string name = state_.scene != nullptr && !state_.scene->info->files.files.empty()
                         ? state_.scene->info->files.files.front().stem().string()
                         : program_;
  const auto is_picture = [](const std::filesystem::path& path, bool folder) {
    return !folder && path.extension() == ".png";
  };
  dialog_.ask({.title = "Export a picture as",
               .button = "Export",
               .writes = true,
               .folder = to,
               .name = std::move(name) + ".png",
               .ending = ".png",
               .shows = is_picture,
               .more = [this] { picture_.draw_choice(); }});
}

std::optional<WindowFiles::Chosen> WindowFiles::chosen() {
  auto files = dialog_.draw();
  if (!files) return std::nullopt;
  std::filesystem::path& chosen_folder = asked_ == Chosen::What::kOpen      ? opened_from_
                                         : asked_ == Chosen::What::kSession ? saved_to_
                                                                            : pictures_to_;
  chosen_folder = files->front().parent_path();
  return Chosen{asked_, std::move(*files)};
}

void WindowFiles::save_session(WindowModel& model, Document document, const std::filesystem::path& file) {
  const bool done = attempt([&] {
    const DrawnLines& lines = all_lines();
    std::filesystem::path& drawn = document.touch.drawn_lines;
    drawn.clear();
    if (lines.entries().empty()) return model.save_session(document, file);
    drawn = lines_of_session(file);
    lines.save(drawn, true);
    const std::string session = model.save_session(document, file);
    saved_.note_saved(lines);
    return session + " with " +
           counted(lines.entries().size(), touch_.data().has_tensors() ? "tract" : "line");
  });
  if (!done) return;
  saved_notes_ = touch_.notes().entries();
  session_ = file;
}

void WindowFiles::save_lines() {
  attempt([this] { return write_lines(); });
}

void WindowFiles::save_picture(const Image& image, const std::vector<PngText>& texts) {
  attempt([&] { return saved_.save_picture(image, texts).string(); });
}

void WindowFiles::save_asked(const PanelActions& actions, const SceneView& view,
                             const std::optional<Box>& region) {
  if (actions.save_transfer && view.volume) {
    attempt([&] {
      Lens context;
      context.transfer = view.volume->transfer;
      context.regions = view.volume->regions;
      return saved_.save_transfer(state_.transfer_file, context).string();
    });
  }
  if (actions.save_focus && state_.scene != nullptr)
    attempt([&] { return saved_.save_transfer(state_.focus_file, state_.scene->appearance(0)).string(); });
  if (!actions.touch.save_notes.empty()) attempt([&] { return write_notes(actions.touch.save_notes); });
  if (!actions.region.crop.empty()) {
    attempt([&] {
      const ImageOrigin origin = state_.scene != nullptr ? state_.scene->info->origin : ImageOrigin();
      const SavedFiles::SavedRegion saved =
          saved_.save_region(*view.volume->image, *region, actions.region.crop, origin);
      std::string text =
          saved.file.string() +
          (saved.exact ? "" : " (to seven digits, as pictures have them; the command clip keeps all)");
      for (const std::string& line : saved.lost) text += "; " + line;
      return text;
    });
  }
}

std::string WindowFiles::write_notes(const std::string& ending) {
  std::string file = saved_.save_annotations(touch_.notes().entries(), ending).string();
  saved_notes_ = touch_.notes().entries();
  return file;
}

std::size_t WindowFiles::unsaved_lines() const {
  const auto whole = [](const DrawnTract& tract) { return tract.line.points.size() > 1; };
  return saved_.unsaved(touch_.trail().drawn_lines()) +
         as_size(std::ranges::count_if(touch_.trail().drawn(), whole));
}

std::size_t WindowFiles::unsaved_notes() const {
  const auto unsaved = [&](const Annotation& note) {
    return std::ranges::find(saved_notes_, note) == saved_notes_.end();
  };
  return as_size(std::ranges::count_if(touch_.notes().entries(), unsaved));
}

bool WindowFiles::ask(const Leaving& leaving) {
  const std::size_t lines = unsaved_lines(), notes = unsaved_notes(), count = lines + notes;
  if (count == 0 || touch_.servo().replaying()) return false;
  std::string what;
  if (lines > 0) what = counted(lines, touch_.data().has_tensors() ? "tract" : "line");
  if (notes > 0) what += (what.empty() ? "" : " and ") + counted(notes, "annotation");
  const std::string forgets = std::string(" forgets ") + (count == 1 ? "it." : "them.");
  question_.ask(
      what + (count == 1 ? " is" : " are") + " not saved." +
          (leaving.way == Leaving::Way::kOpen    ? " Opening another input in place of this one" + forgets
           : leaving.way == Leaving::Way::kClose ? " Closing the data" + forgets
                                                 : " Save before the window closes?"),
      leaving);
  return true;
}

std::optional<Leaving> WindowFiles::answer() {
  const auto answer = question_.draw();
  if (answer == UnsavedQuestion::Answer::kNone || answer == UnsavedQuestion::Answer::kCancel)
    return std::nullopt;
  const bool saves = answer == UnsavedQuestion::Answer::kSave;
  if (saves && unsaved_lines() > 0 && !attempt([this] { return write_lines(); })) return std::nullopt;
  if (saves && unsaved_notes() > 0 && !attempt([this] { return write_notes(".csv"); })) return std::nullopt;
  return question_.leaving();
}

}  // namespace palpate
