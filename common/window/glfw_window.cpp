#include "common/window/glfw_window.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>
#include <utility>

#include <GLFW/glfw3.h>

#include "common/base/error.h"
#include "common/window/window.h"

namespace palpate {
namespace {

std::string no_window(const std::string& why) {
  const char* detail = nullptr;
  glfwGetError(&detail);
  return "no window can be opened: " + why + (detail != nullptr ? " (" + std::string(detail) + ")" : "") +
         "; `render` draws without a display";
}

}  // namespace

// GLFW is ended with the program: some virtual displays start anew, and refuse connections meanwhile, when
// their last one is closed.
bool start_glfw() {
  static const bool kStarted = glfwInit() == GLFW_TRUE && std::atexit(glfwTerminate) == 0;
  return kStarted;
}

void require_glfw() {
  if (!start_glfw()) throw work_error(no_window("no display"));
}

GLFWwindow* create_window(int width, int height, const std::string& title, StereoMode mode,
                          GLFWwindow* share) {
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 4);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 5);
  glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
  // The picture has its own multisampled framebuffer with depth.
  glfwWindowHint(GLFW_DEPTH_BITS, 0);
  glfwWindowHint(GLFW_STENCIL_BITS, 0);
  const bool two_buffers = mode == StereoMode::kQuadBuffer;
  glfwWindowHint(GLFW_STEREO, two_buffers ? GLFW_TRUE : GLFW_FALSE);
  GLFWwindow* window = nullptr;
  for (const int api : {GLFW_NATIVE_CONTEXT_API, GLFW_EGL_CONTEXT_API}) {
    glfwWindowHint(GLFW_CONTEXT_CREATION_API, api);
    window = glfwCreateWindow(width, height, title.c_str(), nullptr, share);
    if (window != nullptr) break;
  }
  if (window == nullptr && two_buffers) {
    glfwWindowHint(GLFW_STEREO, GLFW_FALSE);
    throw work_error(
        "--stereo quad-buffer: this display has no window with a buffer for each eye (a professional "
        "graphics card and its driver's stereo mode are needed); try --stereo rows, side-by-side or "
        "anaglyph");
  }
  if (window == nullptr) throw work_error(no_window("the driver has no OpenGL 4.5 core context"));
  return window;
}

std::array<int, 2> pixel_on_monitor(GLFWwindow* window) {
  int x = 0, y = 0, width = 1, height = 1, pixel_width = 1;
  glfwGetWindowPos(window, &x, &y);
  glfwGetWindowSize(window, &width, &height);
  glfwGetFramebufferSize(window, &pixel_width, nullptr);
  int count = 0;
  GLFWmonitor** const monitors = glfwGetMonitors(&count);
  for (int i = 0; i < count; ++i) {
    int left = 0, top = 0;
    glfwGetMonitorPos(monitors[i], &left, &top);
    const GLFWvidmode* const mode = glfwGetVideoMode(monitors[i]);
    const int middle_x = x + width / 2 - left, middle_y = y + height / 2 - top;
    if (mode == nullptr || middle_x < 0 || middle_y < 0 || middle_x >= mode->width ||
        middle_y >= mode->height)
      continue;
    x -= left;
    y -= top;
    break;
  }
  const double scale = static_cast<double>(pixel_width) / std::max(1, width);
  return {static_cast<int>(std::lround(scale * x)), static_cast<int>(std::lround(scale * y))};
}

GlfwWindow::GlfwWindow(const WindowOptions& options) {
  require_glfw();
  glfwWindowHint(GLFW_VISIBLE, options.hidden ? GLFW_FALSE : GLFW_TRUE);
  // Never larger than what the screen shows of it.
  int width = options.width, height = options.height;
  if (GLFWmonitor* monitor = glfwGetPrimaryMonitor(); monitor != nullptr && !options.hidden) {
    int x = 0, y = 0, screen_width = 0, screen_height = 0;
    glfwGetMonitorWorkarea(monitor, &x, &y, &screen_width, &screen_height);
    if (screen_width > 0) width = std::min(width, screen_width);
    if (screen_height > 0) height = std::min(height, screen_height);
  }
  window_ = create_window(width, height, options.program, options.view.stereo.mode, nullptr);
  glfwMakeContextCurrent(window_);
  listen();
}

GlfwWindow::~GlfwWindow() { glfwDestroyWindow(window_); }

bool GlfwWindow::take_damage() noexcept { return std::exchange(damaged_, false); }

void GlfwWindow::take_keys_of(GLFWwindow* other) {
  glfwSetWindowUserPointer(other, this);
  glfwSetKeyCallback(other, [](GLFWwindow* w, int key, int, int action, int modifiers) {
    auto* const self = static_cast<GlfwWindow*>(glfwGetWindowUserPointer(w));
    self->events_.push_back({.kind = action == GLFW_RELEASE ? InputKind::kKeyUp : InputKind::kKeyDown,
                             .key = key,
                             .modifiers = modifiers});
  });
}

void GlfwWindow::listen() {
  static const auto self = [](GLFWwindow* w) {
    return static_cast<GlfwWindow*>(glfwGetWindowUserPointer(w));
  };
  take_keys_of(window_);
  glfwSetCursorPosCallback(window_, [](GLFWwindow* w, double x, double y) {
    const double scale = self(w)->pixels_per_coordinate();
    self(w)->events_.push_back({.kind = InputKind::kMove, .x = scale * x, .y = scale * y});
  });
  glfwSetMouseButtonCallback(window_, [](GLFWwindow* w, int button, int action, int) {
    if (button < 0 || button > 2) return;
    self(w)->events_.push_back({.kind = action == GLFW_RELEASE ? InputKind::kRelease : InputKind::kPress,
                                .button = static_cast<MouseButton>(button)});
  });
  glfwSetScrollCallback(window_, [](GLFWwindow* w, double x, double y) {
    self(w)->events_.push_back({.kind = InputKind::kWheel, .x = x, .y = y});
  });
  glfwSetCharCallback(window_, [](GLFWwindow* w, unsigned code_point) {
    self(w)->events_.push_back({.kind = InputKind::kText, .key = static_cast<int>(code_point)});
  });
  glfwSetDropCallback(window_, [](GLFWwindow* w, int count, const char** paths) {
    self(w)->events_.push_back({.kind = InputKind::kDrop, .files = {paths, paths + count}});
  });
  // Interlaced pictures are matched to the rows of the monitor.
  glfwSetWindowPosCallback(window_, [](GLFWwindow*, int, int) { glfwPostEmptyEvent(); });
  glfwSetFramebufferSizeCallback(window_, [](GLFWwindow* w, int, int) { self(w)->damaged_ = true; });
  glfwSetWindowRefreshCallback(window_, [](GLFWwindow* w) { self(w)->damaged_ = true; });
}

double GlfwWindow::pixels_per_coordinate() const {
  int window_width = 1, pixel_width = 1;
  glfwGetWindowSize(window_, &window_width, nullptr);
  glfwGetFramebufferSize(window_, &pixel_width, nullptr);
  return window_width > 0 ? static_cast<double>(pixel_width) / window_width : 1.0;
}

std::pair<int, int> GlfwWindow::position() const {
  std::pair<int, int> place{0, 0};
  glfwGetWindowPos(window_, &place.first, &place.second);
  return place;
}

void GlfwWindow::toggle_full_screen() {
  if (glfwGetWindowMonitor(window_) != nullptr) {
    glfwSetWindowMonitor(window_, nullptr, windowed_.x, windowed_.y, windowed_.width, windowed_.height, 0);
    return;
  }
  GLFWmonitor* const monitor = glfwGetPrimaryMonitor();
  const GLFWvidmode* const mode = monitor == nullptr ? nullptr : glfwGetVideoMode(monitor);
  if (mode == nullptr) return;
  glfwGetWindowPos(window_, &windowed_.x, &windowed_.y);
  glfwGetWindowSize(window_, &windowed_.width, &windowed_.height);
  glfwSetWindowMonitor(window_, monitor, 0, 0, mode->width, mode->height, mode->refreshRate);
}

std::pair<int, int> GlfwWindow::size() const {
  if (glfwGetWindowMonitor(window_) != nullptr) return {windowed_.width, windowed_.height};
  std::pair<int, int> size{0, 0};
  glfwGetWindowSize(window_, &size.first, &size.second);
  return size;
}

}  // namespace palpate
