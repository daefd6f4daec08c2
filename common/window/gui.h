/// Dear ImGui for the window: its context, its looks, and the events that it is given.
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "common/render/scene_view.h"
#include "common/window/input_event.h"

struct GLFWwindow;
struct ImGuiContext;

namespace palpate {

/// Owns the context of the panels. Needs the window's OpenGL context current.
class Gui {
 public:
  /// @param text_height of the panels [pixels].
  Gui(GLFWwindow* window, float text_height);
  ~Gui();
  Gui(const Gui&) = delete;
  Gui& operator=(const Gui&) = delete;

  /// Gives the events of a frame (events_of_frame()) to the panels and starts it.
  void begin_frame(const std::vector<InputEvent>& events, int width, int height, double seconds);
  /// Draws the panels over the framebuffer that is bound.
  void end_frame();
  /// The same ones with their upper left corner at each of `corners` [pixels]: once for each eye, where a framebuffer of
  /// width x height pixels has a part for each.
  void end_frame(std::span<const Vec2> corners, int width, int height);

  void set_background(const Background& background);
  [[nodiscard]] float text_height() const noexcept { return text_height_; }

 private:
  ImGuiContext* context_ = nullptr;
  float text_height_;
  std::array<bool, 3> held_{};  // buttons
};

}  // namespace palpate
