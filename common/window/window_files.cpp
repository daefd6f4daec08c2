#include "common/window/window_files.h"

#include <algorithm>
#include <cstddef>
#include <exception>
#include <utility>

#include "common/base/error.h"
#include "common/base/text.h"
#include "common/scene/session_of.h"

namespace palpate {

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

void WindowFiles::save_session(WindowModel& model, Document document) {
  attempt([&] {
    const DrawnLines& lines = all_lines();
    std::filesystem::path& file = document.touch.drawn_lines;
    file.clear();
    if (lines.entries().empty()) return model.save_session(document);
    file = session_path(document, program_).replace_extension(".lines.csv");
    lines.save(file, true);
    const std::string session = model.save_session(document);
    saved_.note_saved(lines);
    return session + " with " +
           counted(lines.entries().size(), touch_.data().has_tensors() ? "tract" : "line");
  });
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
    attempt([&] { return saved_.save_transfer(state_.focus_file, state_.scene->look(0)).string(); });
  if (!actions.touch.save_notes.empty()) {
    attempt(
        [&] { return saved_.save_annotations(touch_.notes().entries(), actions.touch.save_notes).string(); });
  }
  if (!actions.region.crop.empty()) {
    attempt([&] {
      const SavedFiles::SavedRegion saved =
          saved_.save_region(*view.volume->image, *region, actions.region.crop,
                             view.anatomical ? ImageSpace::kPatient : ImageSpace::kUnknown);
      return saved.file.string() +
             (saved.exact ? "" : " (to seven digits, as pictures have them; the command clip keeps all)");
    });
  }
}

bool WindowFiles::ask(std::optional<InputFiles> opens) {
  const auto whole = [](const DrawnTract& tract) { return tract.line.points.size() > 1; };
  const std::size_t count = saved_.unsaved(touch_.trail().drawn_lines()) +
                            static_cast<std::size_t>(std::ranges::count_if(touch_.trail().drawn(), whole));
  if (count == 0 || touch_.servo().replaying()) return false;
  const std::string lines = counted(count, touch_.data().has_tensors() ? "tract" : "line");
  question_.ask(lines + (count == 1 ? " is" : " are") + " not saved." +
                    (opens ? " Opening another input in place of this one forgets " +
                                 std::string(count == 1 ? "it." : "them.")
                           : " Save before the window closes?"),
                std::move(opens));
  return true;
}

std::optional<WindowFiles::Leave> WindowFiles::answer() {
  const auto answer = question_.draw();
  if (answer == UnsavedQuestion::Answer::kNone || answer == UnsavedQuestion::Answer::kCancel)
    return std::nullopt;
  if (answer == UnsavedQuestion::Answer::kSave && !attempt([this] { return write_lines(); }))
    return std::nullopt;
  return Leave{.opens = question_.opens()};
}

}  // namespace palpate
