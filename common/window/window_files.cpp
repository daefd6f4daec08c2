#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <GLFW/glfw3.h>

#include "common/base/error.h"
#include "common/base/text.h"
#include "common/window/explorer_window.h"

namespace palpate {

bool ExplorerWindow::asked_about(std::optional<InputFiles> opens) {
  const std::size_t count =
      files_.unsaved(touch_->kept()) +
      static_cast<std::size_t>(std::ranges::count_if(
          touch_->drawn(), [](const DrawnTract& tract) { return tract.line.points.size() > 1; }));
  if (count == 0 || touch_->replaying()) return false;
  touch_control_->let_go();
  const std::string lines = counted(count, touch_->has_tensors() ? "tract" : "line");
  question_.ask(lines + (count == 1 ? " is" : " are") + " not saved." +
                    (opens ? " Opening another input in place of this one forgets " +
                                 std::string(count == 1 ? "it." : "them.")
                           : " Save before the window closes?"),
                std::move(opens));
  return true;
}

void ExplorerWindow::open(const InputFiles& files) {
  if (!asked_about(files)) to_open_ = files;
}

void ExplorerWindow::answer_question() {
  const auto answer = question_.draw();
  if (answer == UnsavedQuestion::Answer::kNone || answer == UnsavedQuestion::Answer::kCancel) return;
  if (answer == UnsavedQuestion::Answer::kSave && !attempt([this] { return save_lines(); })) return;
  if (question_.opens()) {
    to_open_ = question_.opens();
  } else {
    leave_ = true;
    glfwSetWindowShouldClose(glfw_.get(), GLFW_TRUE);
  }
}

std::filesystem::path ExplorerWindow::save_lines() {
  if (!touch_->drawn().empty()) (void)touch_->keep_line();
  if (touch_->kept().entries().empty())
    throw work_error(touch_->has_tensors() ? "no tract is drawn; press G, then drag along one"
                                           : "no line is kept; grab the probe (G), then K keeps one");
  return files_.save_lines(touch_->kept(), state_.lines_file);
}

bool ExplorerWindow::attempt(const std::function<std::filesystem::path()>& save) {
  try {
    say("saved " + save().string(), false);
    return true;
  } catch (const std::exception& error) {
    say(error.what(), true);
    return false;
  }
}

void ExplorerWindow::save_asked(const PanelActions& actions) {
  if (actions.save_transfer && view_.volume) {
    attempt([this] {
      Lens context;
      context.transfer = view_.volume->transfer;
      context.regions = view_.volume->regions;
      return files_.save_transfer(state_.transfer_file, context);
    });
  }
  if (actions.save_focus && scene_) {
    attempt([this] { return files_.save_transfer(state_.focus_file, scene_->look(0)); });
  }
  if (!actions.touch.save_notes.empty())
    attempt([&] { return files_.save_annotations(touch_->notes().entries(), actions.touch.save_notes); });
  if (!actions.region.crop.empty()) {
    attempt([&] {
      return files_.save_region(*view_.volume->image, *region_control_.box(), actions.region.crop,
                                view_.anatomical ? ImageSpace::kPatient : ImageSpace::kUnknown);
    });
  }
}

std::vector<std::pair<std::string, std::string>> ExplorerWindow::set_options() const {
  auto set = touch_->options();
  if (!state_.plotted.empty()) set.emplace_back("plot", state_.plotted);
  if (const auto& box = region_control_.box(); box && has_region()) set.emplace_back("box", box_text(*box));
  if (state_.play_rate != kPlayRate) set.emplace_back("play-rate", exact_number(state_.play_rate));
  return set;
}

std::vector<PngText> ExplorerWindow::picture_texts() const {
  return {{"Software", options_.version}, {"Comment", options_.command_line}};
}

}  // namespace palpate
