#include "common/window/files/picture_export.h"

#include <algorithm>
#include <array>
#include <exception>
#include <utility>

#include <GLFW/glfw3.h>
#include <imgui.h>

#include "common/render/render_panes.h"
#include "common/render/transparent_picture.h"
#include "common/window/panels/panel_parts.h"

namespace palpate {
namespace {

struct Size {
  int width, height;
};

std::string size_words(const char* before, const Size& size) {
  return before + std::to_string(size.width) + " x " + std::to_string(size.height);
}

}  // namespace

void PictureExport::begin(int width, int height) {
  seen_width_ = width;
  seen_height_ = height;
  if (own_size_) return;
  choice_.width = width;
  choice_.height = height;
}

void PictureExport::draw_choice() {
  const float em = ImGui::GetFontSize();
  const Size seen{seen_width_, seen_height_}, twice{2 * seen_width_, 2 * seen_height_};
  const std::array sizes{std::pair(size_words("as seen: ", seen), seen),
                         std::pair(size_words("twice that: ", twice), twice),
                         std::pair(std::string("1920 x 1080"), Size{1920, 1080}),
                         std::pair(std::string("3840 x 2160"), Size{3840, 2160})};
  std::array<int, 2> size{choice_.width, choice_.height};
  ImGui::SetNextItemWidth(11.0F * em);
  if (drag_int("##picture-size", size.data(), 2, 4.0F, PictureChoice::kSmallest, PictureChoice::kLargest,
               0)) {
    choice_.width = size[0];
    choice_.height = size[1];
    own_size_ = true;
  }
  hint("width and height in pixels: drag, or Ctrl+click and type");
  ImGui::SameLine();
  ImGui::SetNextItemWidth(14.0F * em);
  if (begin_combo("size", "sizes")) {
    for (const auto& [words, each] : sizes) {
      if (!selectable(words.c_str())) continue;
      choice_.width = std::min(each.width, PictureChoice::kLargest);
      choice_.height = std::min(each.height, PictureChoice::kLargest);
      own_size_ = each.width != seen_width_ || each.height != seen_height_;
    }
    ImGui::EndCombo();
  }
  (void)checkbox("transparent", &choice_.transparent);
  hint("nothing where the background would be");
  if (choice_.transparent) return;
  ImGui::SameLine();
  constexpr std::array<const char*, 4> kNames{"as seen", "white", "black", "a colour"};
  const Rgb white(1.0F), black(0.0F);
  const auto& now = choice_.background;
  int chosen = !now ? 0 : *now == white ? 1 : *now == black ? 2 : 3;
  ImGui::SetNextItemWidth(8.0F * em);
  if (combo("background of the picture", &chosen, kNames.data(), static_cast<int>(kNames.size()))) {
    const Rgb grey(0.5F);
    choice_.background = chosen == 0 ? std::nullopt
                                     : std::optional(chosen == 1   ? white
                                                     : chosen == 2 ? black
                                                                   : grey);
  }
  if (chosen != 3) return;
  ImGui::SameLine();
  ImGui::SetNextItemWidth(11.0F * em);
  (void)color_edit("##picture-background", &choice_.background->x);
}

void PictureExport::ask(SceneView view, const std::filesystem::path& file, std::vector<PngText> texts) {
  if (choice_.background) view.background = {*choice_.background, *choice_.background};
  asked_ = Asked{std::move(view), file, std::move(texts)};
  glfwPostEmptyEvent();
}

std::optional<PictureExport::Outcome> PictureExport::take() {
  if (!asked_) return std::nullopt;
  if (!std::exchange(asked_->said, true)) {
    glfwPostEmptyEvent();
    return std::nullopt;
  }
  const Asked asked = *std::exchange(asked_, std::nullopt);
  glfwMakeContextCurrent(nullptr);  // EGL takes no thread that has a context of GLX
  try {
    const Image image = choice_.transparent ? transparent_picture(asked.view, choice_.width, choice_.height)
                                            : render_panes(asked.view, choice_.width, choice_.height).image;
    write_png(asked.file, image, asked.texts);
    return Outcome{asked.file.string(), true};
  } catch (const std::exception& error) {
    return Outcome{error.what(), false};
  }
}

}  // namespace palpate
