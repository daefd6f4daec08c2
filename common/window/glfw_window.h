/// A window of the system with an OpenGL 4.5 core context, and its events as plain data.
#pragma once

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "common/geometry/screen.h"
#include "common/window/input_event.h"

struct GLFWwindow;

namespace palpate {

struct WindowOptions;

/// Starts GLFW, once for the whole program. @return whether there is a display.
[[nodiscard]] bool start_glfw();

/// The same. @throws Error (work failed) where there is no display.
void require_glfw();

/// A window with such a context, hidden or not as GLFW's hints say. @param share whose objects it sees, or
/// null.
/// @throws Error (work failed) where none can be opened: for kQuadBuffer where the display has no two
/// buffers.
[[nodiscard]] GLFWwindow* create_window(int width, int height, const std::string& title, StereoMode mode,
                                        GLFWwindow* share);

/// Column and row of the upper left pixel of the window's picture, counted from the corner of the monitor
/// that shows the window's middle; as if it filled the monitor, where the system does not say where it is.
[[nodiscard]] std::array<int, 2> pixel_on_monitor(GLFWwindow* window);

class GlfwWindow {
 public:
  /// Makes the context current.
  /// @throws Error (work failed) where no window can be opened.
  explicit GlfwWindow(const WindowOptions& options);
  ~GlfwWindow();
  GlfwWindow(const GlfwWindow&) = delete;
  GlfwWindow& operator=(const GlfwWindow&) = delete;

  [[nodiscard]] GLFWwindow* get() const noexcept { return window_; }
  /// What came since the events were cleared; positions in pixels. The owner may add to them.
  [[nodiscard]] std::vector<InputEvent>& events() noexcept { return events_; }
  /// Whether the window has to be drawn again whatever it shows; asked once.
  [[nodiscard]] bool take_damage() noexcept;
  /// Keys that are pressed in another window count as if they were in this one: the force is off at once
  /// wherever the keyboard is. This one outlives it.
  void take_keys_of(GLFWwindow* other);
  void toggle_full_screen();
  /// Width and height, those before where it takes the full screen [screen coordinates].
  [[nodiscard]] std::pair<int, int> size() const;
  /// Where its upper left corner is on the desktop; zero where the system does not say it [screen
  /// coordinates].
  [[nodiscard]] std::pair<int, int> position() const;
  [[nodiscard]] double pixels_per_coordinate() const;

 private:
  void listen();

  GLFWwindow* window_ = nullptr;
  std::vector<InputEvent> events_;
  bool damaged_ = true;
  struct {
    int x = 0, y = 0, width = 1, height = 1;
  } windowed_;  // before it took the full screen
};

}  // namespace palpate
