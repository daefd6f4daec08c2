#include "common/window/panels/picture_panels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "common/base/index.h"
#include "common/base/text.h"
#include "common/window/keys.h"
#include "common/window/panels/banners.h"
#include "common/window/panels/panel_parts.h"
#include "common/window/panels/tensor_readout.h"

namespace palpate {
namespace {

ImVec2 place(double x, double y) { return {static_cast<float>(x), static_cast<float>(y)}; }

/// "0.432 s"
std::string seconds_text(double seconds) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.3g s", seconds);
  return text.data();
}

std::string status_text(const SceneState& scene) {
  if (scene.is_volume_alone()) {
    const VolumeImage& image = *scene.volume->image;
    return size_text(scene) + ", values " + short_number(image.lowest) + " to " +
           short_number(image.highest) + "   loaded in " + seconds_text(scene.seconds_load);
  }
  if (scene.tensors || scene.tracts) {
    std::string text = size_text(scene) + "   loaded in " + seconds_text(scene.seconds_load);
    if (scene.tracts && scene.tensors) {
      text += "   " + counted(scene.tracts->bundle->order.size(), "tract");
      if (scene.seeds > 0)
        text += " from " + counted(scene.seeds, "seed") + " in " + seconds_text(scene.seconds_trace);
    }
    return text;
  }
  if (scene.seeds == 0) return scene.lines->empty() ? "" : counted(scene.lines->size(), "line");
  std::string text = counted(scene.lines->size(), "line") + " from ";
  if (scene.seeds_left_out > 0) text += std::to_string(scene.seeds - scene.seeds_left_out) + " of ";
  text += counted(scene.seeds, "seed");
  if (scene.seeds_left_out > 0) text += ", as --memory allows";
  if (scene.outside_seeds > 0) text += " (" + std::to_string(scene.outside_seeds) + " outside)";
  const char* separator = ": ";
  for (int k = 0; k < kEndCount; ++k) {
    const std::size_t count = scene.ends[as_size(k)];
    if (count == 0) continue;
    std::string name(name_of(static_cast<End>(k)));
    std::replace(name.begin(), name.end(), '_', ' ');
    text += separator + std::to_string(count) + " " + name;
    separator = ", ";
  }
  if (scene.line_errors.held > 0 || !scene.line_errors.unheld_seeds.empty())
    text += "   " + errors_text(scene.line_errors);
  return text + "   traced in " + seconds_text(scene.seconds_trace);
}

/// What is given up, first what is given up first, and the time.
std::string frame_text(const PanelState& state) {
  std::string text;
  const FrameQuality& quality = state.picture.quality;
  std::array<char, 128> part{};
  const auto give_up = [&](double share, const char* what) {
    if (share >= 1.0) return;
    std::snprintf(part.data(), part.size(), "%.0f %% of the %s, ", 100.0 * share, what);
    text += part.data();
  };
  give_up(quality.context, "samples");
  give_up(quality.detail, "lines' detail");
  give_up(quality.viewport, "resolution around lenses");
  give_up(quality.resolution, "resolution");
  give_up(quality.focus, "samples in lenses");
  if (const auto& coarser = state.picture.coarser_voxels) {
    const Index3& n = coarser->points;
    std::snprintf(part.data(), part.size(), "coarser: %d x %d x %d voxels, ", n.x, n.y, n.z);
    text += part.data();
    if (coarser->hidden > 0.0) {
      std::snprintf(part.data(), part.size(), "%.3g %% or more of what shows lost in them, ",
                    100.0 * coarser->hidden);
      text += part.data();
    }
  }
  if (const BrickShare& bricks = state.picture.bricks; bricks.all > 0) {
    std::snprintf(part.data(), part.size(), "bricks: %zu of %zu, %zu in all, %llu in, %llu out, %.0f MB, ",
                  bricks.held, bricks.wanted, bricks.all, static_cast<unsigned long long>(bricks.entered),
                  static_cast<unsigned long long>(bricks.left),
                  std::ldexp(static_cast<double>(bricks.bytes), -20));
    text += part.data();
  }
  if (const TractShare& share = state.picture.tracts; share.drawn < share.all)
    text += std::to_string(share.drawn) + " of " + counted(share.all, "tract") + ", ";
  if (const auto& error = state.picture.error) {
    std::snprintf(part.data(), part.size(), "error%s %.2g/255, worst %.0f, ",
                  error->of_asked_voxels ? "" : " of samples alone", 255.0 * error->rms,
                  255.0 * error->worst);
    text += part.data();
  }
  if (const auto& error = state.picture.expected_error) {
    std::snprintf(part.data(), part.size(), "error about %.2g/255, ", 255.0 * *error);
    text += part.data();
  }
  std::snprintf(part.data(), part.size(), "%.1f ms", state.picture.milliseconds);
  return text + part.data();
}

void draw_status(const PanelState& state, const WindowLayout& layout) {
  ImGui::SetNextWindowPos(place(layout.picture.left, layout.picture.top + layout.picture.height));
  ImGui::SetNextWindowSize(place(layout.picture.width, layout.status_height));
  ImGui::Begin("status", nullptr, kFixedPanel | ImGuiWindowFlags_NoScrollbar);
  const std::string frame = frame_text(state);
  const float frame_width = ImGui::CalcTextSize(frame.c_str()).x;
  const float right = ImGui::GetWindowWidth() - ImGui::GetStyle().WindowPadding.x;

  // Cut where the time begins; all of it is in the tooltip.
  std::string words = !state.message.empty()   ? state.message
                      : state.scene != nullptr ? status_text(*state.scene)
                                               : std::string();
  if (!state.aside.empty()) words += (words.empty() ? "" : "; ") + state.aside;
  const float room = right - frame_width - ImGui::GetFontSize() - ImGui::GetCursorPosX();
  ImGui::TextUnformatted(shortened(words, room).c_str());
  hint("%s", words.c_str());
  ImGui::SameLine(right - frame_width);
  ImGui::TextDisabled("%s", frame.c_str());
  ImGui::End();
}

/// Whether a key is of use for what is open.
bool concerns(Command command, const PanelState& state) {
  const SceneState* const scene = state.scene;
  const bool touch = state.touch != nullptr && state.touch->available();
  const bool flow = touch && state.touch->data().has_flow();
  switch (command) {
    case Command::kKeepLine:
    case Command::kSaveLines:
      return flow || (touch && (state.touch->data().has_tensors() || state.touch->data().has_wall()));
    case Command::kLocalLines:
      return flow;
    case Command::kGrab:
    case Command::kLockX:
    case Command::kLockY:
    case Command::kLockZ:
    case Command::kForceOff:
    case Command::kMode1:
      return touch;
    case Command::kCorner:
    case Command::kLayout:
      return scene != nullptr && scene->is_volume_alone();
    case Command::kLens:
    case Command::kLensSmaller:
      return scene != nullptr && (scene->volume || scene->info->layers);
    case Command::kVolume:
      return scene != nullptr && scene->volume;
    case Command::kSliceRight:
    case Command::kSliceFront:
    case Command::kSliceUp:
      return scene != nullptr && (scene->tensors || scene->is_volume_alone());
    case Command::kPlay:
      return flow || (scene != nullptr && scene->info->times.size() > 1);
    case Command::kStepBack:
      return scene != nullptr && scene->info->times.size() > 1;
    default:
      return true;
  }
}

void list_keys(const PanelState& state, float width) {
  if (!ImGui::BeginTable("keys", 2, ImGuiTableFlags_SizingFixedFit)) return;
  ImGui::TableSetupColumn("key");
  ImGui::TableSetupColumn("what", ImGuiTableColumnFlags_WidthFixed, width);
  const auto row = [](const char* name, const char* what) {
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    ImGui::TextDisabled("%s", name);
    ImGui::TableNextColumn();
    ImGui::PushTextWrapPos(0.0F);
    ImGui::TextUnformatted(what);
    ImGui::PopTextWrapPos();
  };
  const bool volume = state.scene != nullptr && state.scene->volume;
  const bool touch = state.touch != nullptr && state.touch->available();
  row("left drag", "turn about the focal point");
  row("middle drag", "pan");
  row("right drag, wheel", "zoom");
  row("drop files", "open them");
  row("Ctrl+click on a slider", "type its number");
  if (concerns(Command::kLens, state)) row("wheel, lens at mouse", "its size; with Ctrl along the view");
  if (volume) row("Ctrl+drag on a plane", "its image: right widens the window, up raises the level");
  if (concerns(Command::kLayout, state)) {
    row("drag in a slice", "the crosshair of all; with Shift it turns the other two");
    row("right, middle drag", "in a slice: window and level, or move it");
    row("wheel on a slice", "go through it; Ctrl and the wheel zoom");
  } else if (concerns(Command::kSliceUp, state)) {
    row("click", "put the crosshair of slices there; drag it with Ctrl");
    row("wheel on a slice", "move it; Ctrl and the wheel zoom");
  }
  if (touch)
    row("mouse, wheel", "while the probe is grabbed: move it in the plane of the view, and along the view");
  if (touch && state.touch->planes()) {
    row("drag a plane's sphere", "turn the plane; along a great circle about one axis alone");
    row("drag a plane's ring", "move the plane; along an axis on that alone");
  } else if (touch && state.touch->hand().takes_hold()) {
    row("drag with the probe", "on the grid: carry the view along it, or the face of a region that it is at");
  }
  if (touch && state.touch->data().scalar() && !state.touch->data().has_flow())
    row("click, marking", "annotate: a point, length, angle, curve or area (Mark by clicks in the panel)");
  for (const KeyBinding& binding : key_bindings()) {
    if (*binding.name != '\0' && concerns(binding.command, state)) row(binding.name, binding.what);
  }
  ImGui::EndTable();
}

/// In the middle of the picture, or where that is too small, of the window; it scrolls where it is higher.
void draw_help(PanelState& state, const WindowLayout& layout) {
  if (!state.show_help) return;
  constexpr float kNames = 12.0F, kWords = 34.0F, kLeastWords = 18.0F;  // heights of the text
  const float em = ImGui::GetFontSize();
  const ImVec2 window = ImGui::GetIO().DisplaySize;
  const auto picture = static_cast<float>(layout.picture.width);
  const bool on_picture = picture > (kNames + kLeastWords) * em;
  const float room = (on_picture ? picture : window.x) - 2.0F * em;
  const float words = std::clamp(room - kNames * em, 8.0F * em, kWords * em);
  const float middle =
      on_picture ? static_cast<float>(layout.picture.left) + 0.5F * picture : 0.5F * window.x;
  ImGui::SetNextWindowPos({middle, 0.5F * window.y}, ImGuiCond_Always, {0.5F, 0.5F});
  ImGui::SetNextWindowSizeConstraints({0.0F, 0.0F}, {room, window.y - 2.0F * em});
  ImGui::SetNextWindowBgAlpha(0.94F);
  ImGui::Begin(
      "Keys and mouse", &state.show_help,
      ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings);
  note_control("keys", ImGui::GetWindowPos(), ImGui::GetWindowSize());
  list_keys(state, words);
  ImGui::End();
}

/// Read-outs over the picture, below its title: the colour bars are on the other side.
void draw_readouts(const PanelState& state, const WindowLayout& layout) {
  const float em = ImGui::GetFontSize();
  constexpr float kBars = 9.0F;  // heights of the text
  const bool beside_bars = state.document.view.color_bar && state.document.view.color_bar_side == "left";
  const float left = static_cast<float>(layout.picture.left) + (beside_bars ? kBars : 1.0F) * em;
  constexpr float kTitle = 6.0F;  // heights of the text
  float top = static_cast<float>(layout.picture.top) + kTitle * em;
  if (state.touch != nullptr) {
    const float height = draw_probe_readout(*state.touch, state.histogram.last(), left, top);
    if (height > 0.0F) top += height + 0.5F * em;
  }
  if (state.tensor) top += draw_tensor_readout(*state.tensor, left, top) + 0.5F * em;
  if (!state.show_rates) return;
  ImGui::SetNextWindowPos({left, top});
  ImGui::SetNextWindowBgAlpha(0.7F);
  ImGui::Begin("rates", nullptr, kFixedPanel | ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoInputs);
  ReadoutRows rows("rates");
  rows.add("picture", "%.1f ms", state.picture.milliseconds);
  rows.add("frames", "%.1f /s", state.picture.frames_per_second);
  if (const auto& error = state.picture.error) {
    rows.add("image error", "%.2g +- %.1g /255, worst %.0f", 255.0 * error->rms, 255.0 * error->spread,
             255.0 * error->worst);
    rows.add("looked at", "%.0f pixels in %.0f ms", static_cast<double>(error->pixels), error->milliseconds);
  }
  if (state.scene != nullptr) {
    std::size_t points = 0;
    for (const Line& line : *state.scene->lines) points += line.points.size();
    rows.add("points", "%.0f", static_cast<double>(points));
    rows.add("load", "%.3g s", state.scene->seconds_load);
    rows.add("trace", "%.3g s", state.scene->seconds_trace);
  }
  for (const auto& [name, value] : state.head_rows) rows.add(name.c_str(), "%s", value.c_str());
  if (state.touch != nullptr) add_servo_rates(*state.touch, rows);
  rows.finish();
  ImGui::End();
}

}  // namespace

std::string size_text(const SceneState& scene) {
  if (scene.tracts && !scene.tensors) return counted(scene.tracts->bundle->order.size(), "tract");
  if (!scene.tensors && !scene.is_volume_alone()) return counted(scene.lines->size(), "line");
  const Index3& n = scene.volume ? scene.volume->image->points : scene.tensors->image->points;
  return std::to_string(n.x) + " x " + std::to_string(n.y) + " x " + std::to_string(n.z) + " voxels";
}

void draw_overlays(PanelState& state, const WindowLayout& layout) {
  draw_banners(state, layout);
  draw_help(state, layout);
  state.log.draw();
}

void draw_picture_panels(PanelState& state, const WindowLayout& layout) {
  draw_status(state, layout);
  draw_readouts(state, layout);
  draw_overlays(state, layout);
}

}  // namespace palpate
