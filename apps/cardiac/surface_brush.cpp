#include "apps/cardiac/surface_brush.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <utility>

#include <imgui.h>

#include "apps/cardiac/wall_view.h"
#include "common/field/layer/paint_surfaces.h"
#include "common/window/controls/pick_volume.h"
#include "common/window/files/saved_files.h"
#include "common/window/panels/panel_parts.h"

namespace palpate {
namespace {

constexpr std::array<BorderRole, 5> kPainted{BorderRole::kInner, BorderRole::kRight, BorderRole::kSeptum,
                                             BorderRole::kOuter, BorderRole::kBase};

/// Where the ray first meets the wall: surfaces that are not coloured by values, or all where those are all there is.
std::optional<Vec3> wall_under(const ViewRay& ray, const std::vector<SurfaceView>& surfaces, bool layered) {
  return pick_surface(ray, surfaces,
                      [layered](const SurfaceView& surface) { return !layered || !surface.values; });
}

ImVec4 shown(const Rgb& color) { return {color.r, color.g, color.b, 1.0F}; }

}  // namespace

void SurfaceBrush::operator()(PanelContext& on) {
  const bool layered = on.scene.info->layers.has_value();
  Document& document = on.state.document;
  if (TagWriter::News news = tags_->news(); news.failed) {
    on.state.fail(std::move(news.words));
  } else if (!news.words.empty()) {
    on.state.say(std::move(news.words));
  }
  if (!section("WALL")) {
    on_ = false;
    return;
  }
  if (layered) {
    edit_setting("walls", document.heart.walls);
    if (!document.heart.cut.empty()) edit_setting("cut-face", document.heart.cut_face);
  }
  if (!layered || document.heart.walls == "found") {
    for (const BorderRole role : kPainted) {
      ImGui::PushStyleColor(ImGuiCol_Text, shown(color_of(role)));
      if (selectable(name_of(role), on_ && role == role_)) {
        on_ = !on_ || role != role_;
        role_ = role;
        if (on_)
          on.state.say(std::string("paints the wall as ") + name_of(role) +
                       "; press it again to put the brush away");
      }
      ImGui::PopStyleColor();
      hint("take the brush: the mouse paints the wall with it, where its surfaces were taken for others");
    }
    if (on_) {
      (void)slider("brush", size_, 0.005, 0.3, "%.3f");
      hint("radius, in diagonals of the scene");
      paint(on);
    }
    if (!document.input.paint.empty()) {
      if (small_button("take all paint off")) document.input.paint.clear();
      explain("paint-surface");
      ImGui::TextWrapped("A session keeps the paint; tags keep it in the mesh.");
    }
    save_tags(on);
  } else {
    on_ = false;
  }
}

/// In the current folder, as lines and pictures are.
void SurfaceBrush::save_tags(PanelContext& on) {
  ImGui::BeginDisabled(tags_->running());
  if (small_button("save surfaces as tags")) {
    const InputOptions& input = on.state.document.input;
    const std::string stem = input.files.empty() ? input.example : input.files.front().stem().string();
    tags_->start(on.state.document, free_place(std::filesystem::current_path(), stem + "-tags", ".vtu"));
  }
  ImGui::EndDisabled();
  hint(
      "writes the wall's mesh with an array 'surface', which says of each point which surface it is of: a file that has "
      "one is opened by it (as cardiac info --surfaces FILE.vtu)");
}

void SurfaceBrush::paint(PanelContext& on) {
  const ImGuiIO& io = ImGui::GetIO();
  const ImVec2 mouse = io.MousePos;
  const bool over =
      on.picture.contains(mouse.x, mouse.y) && !ImGui::IsWindowHovered(ImGuiHoveredFlags_AnyWindow);
  // The mouse is the brush's: the camera does not turn.
  if (over || !stroke_.empty()) ImGui::CaptureMouseFromApp(true);
  const double radius = size_ * on.scene.info->bounds.diagonal();
  if (over) {
    const ViewRay ray =
        view_ray(on.view.camera, size_of(on.picture), {mouse.x - on.picture.left, mouse.y - on.picture.top});
    const auto at = wall_under(ray, on.scene.surfaces, on.scene.info->layers.has_value());
    if (at) {
      const PictureSize size = size_of(on.picture);
      const Vec3 middle = project(on.view.camera, *at, size.width, size.height);
      const Vec3 rim =
          project(on.view.camera, *at + radius * on.view.camera.axes[0], size.width, size.height);
      ImGui::GetForegroundDrawList()->AddCircle(
          mouse, static_cast<float>(std::hypot(rim.x - middle.x, rim.y - middle.y)),
          ImGui::ColorConvertFloat4ToU32(shown(color_of(role_))), 0, 2.0F);
      constexpr double kStep = 0.5;  // of the radius, from one ball of paint to the next
      if (io.MouseDown[0] && (!last_ || glm::distance(*last_, *at) > kStep * radius)) {
        stroke_.push_back(paint_text({role_, *at, radius}));
        last_ = at;
      }
    }
  }
  if (io.MouseDown[0] || stroke_.empty()) return;
  std::vector<std::string>& paint = on.state.document.input.paint;
  paint.insert(paint.end(), stroke_.begin(), stroke_.end());
  stroke_.clear();
  last_.reset();
}

}  // namespace palpate
