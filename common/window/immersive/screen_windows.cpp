#include "common/window/immersive/screen_windows.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>

#include <GLFW/glfw3.h>
#include <epoxy/gl.h>

#include "common/base/error.h"
#include "common/render/gl/object.h"
#include "common/render/gl/target.h"
#include "common/render/scene_renderer.h"
#include "common/render/stereo/stereo_pass.h"
#include "common/window/glfw_window.h"

namespace palpate {
namespace {

constexpr int kUsualWidth = 1280;  // of a screen whose pixels are not known

struct ScreenWindow {
  ScreenGeometry screen;
  StereoView stereo;
  GLFWwindow* window = nullptr;
  GlTexture picture;                     // shared by both contexts
  GlFramebuffer framebuffer;             // on it, in the main context
  std::uint32_t window_framebuffer = 0;  // likewise in the window's own
  int width = 0, height = 0;             // of the window [pixels]
  std::optional<SceneView> shown;
  double resolution = 1.0;  // at which that was drawn
  double detail = 1.0;      // likewise

  /// A picture for two buffers holds both.
  [[nodiscard]] int picture_height() const {
    return stereo.mode == StereoMode::kQuadBuffer ? 2 * height : height;
  }
};

GLFWwindow* open_window(GLFWwindow* main, const ScreenGeometry& screen, StereoMode mode, bool hidden) {
  int width = screen.pixels[0], height = screen.pixels[1];
  if (width == 0) {
    width = kUsualWidth;
    height = static_cast<int>(
        std::lround(kUsualWidth * palpate::height(screen.corners) / palpate::width(screen.corners)));
  }
  glfwWindowHint(GLFW_DECORATED, GLFW_FALSE);
  glfwWindowHint(GLFW_FOCUSED, GLFW_FALSE);
  glfwWindowHint(GLFW_VISIBLE, GLFW_FALSE);
  GLFWwindow* const window = create_window(width, height, "palpate " + screen.name, mode, main);
  glfwWindowHint(GLFW_DECORATED, GLFW_TRUE);
  glfwWindowHint(GLFW_FOCUSED, GLFW_TRUE);
  glfwSetWindowPos(window, screen.position[0], screen.position[1]);
  if (!hidden) glfwShowWindow(window);
  return window;
}

}  // namespace

struct ScreenWindows::State {
  GLFWwindow* main = nullptr;
  SceneRenderer renderer;
  std::vector<ScreenWindow> windows;

  void resize(ScreenWindow& w) const {
    int width = 0, height = 0;
    glfwGetFramebufferSize(w.window, &width, &height);
    if (width == w.width && height == w.height) return;
    w.width = width;
    w.height = height;
    w.shown.reset();
    if (width < 1 || height < 1) return;
    GLuint name = 0;
    glCreateTextures(GL_TEXTURE_2D, 1, &name);
    w.picture = GlTexture(name);
    glTextureStorage2D(name, 1, GL_RGBA8, width, w.picture_height());
    GLuint buffer = 0;
    glCreateFramebuffers(1, &buffer);
    w.framebuffer = GlFramebuffer(buffer);
    glNamedFramebufferTexture(buffer, GL_COLOR_ATTACHMENT0, name, 0);
    // Framebuffers belong to a context, textures to all that share.
    glFinish();
    glfwMakeContextCurrent(w.window);
    glfwSwapInterval(0);  // the main window alone waits for its screen
    if (w.window_framebuffer == 0) glCreateFramebuffers(1, &w.window_framebuffer);
    glNamedFramebufferTexture(w.window_framebuffer, GL_COLOR_ATTACHMENT0, name, 0);
    glfwMakeContextCurrent(main);
  }

  static void show(const ScreenWindow& w) {
    // Of two buffers the picture holds the left eye's on top.
    const std::array<EyeSource, 2> eyes{EyeSource{w.window_framebuffer, w.picture_height() - w.height},
                                        EyeSource{w.window_framebuffer, 0}};
    const bool two = w.stereo.mode == StereoMode::kQuadBuffer;
    show_eyes(eyes, w.width, w.height, 0, two ? window_eye_buffers() : std::vector<std::uint32_t>{GL_BACK}, 0,
              0);
    glfwSwapBuffers(w.window);
  }
};

ScreenWindows::ScreenWindows(GlfwWindow& main, const WorkbenchDisplayOptions& workbench,
                             const StereoView& stereo, bool hidden)
    : state_(std::make_unique<State>()) {
  state_->main = main.get();
  for (const ScreenGeometry& screen : workbench.workbench.screens) {
    ScreenWindow window{.screen = screen, .stereo = stereo};
    if (stereo.mode == StereoMode::kNone) window.stereo.mode = screen.stereo;
    window.window = open_window(main.get(), screen, window.stereo.mode, hidden);
    main.take_keys_of(window.window);
    state_->windows.push_back(std::move(window));
  }
  glfwMakeContextCurrent(main.get());
}

ScreenWindows::~ScreenWindows() {
  for (const ScreenWindow& w : state_->windows) {
    if (w.window_framebuffer != 0) {
      glfwMakeContextCurrent(w.window);
      glDeleteFramebuffers(1, &w.window_framebuffer);
      glfwMakeContextCurrent(state_->main);
    }
    glfwDestroyWindow(w.window);
  }
}

void ScreenWindows::draw(const SceneView& view, const WorkbenchDisplay& workbench,
                         const FrameQuality& quality) {
  std::vector<const ScreenWindow*> drawn;
  for (ScreenWindow& w : state_->windows) {
    state_->resize(w);
    if (w.width < 1 || w.height < 1) continue;
    SceneView seen = with_quality(view, quality);
    seen.stereo = w.stereo;
    seen.stereo.first = pixel_on_monitor(w.window);
    workbench.show(w.screen.corners, seen);
    if (w.shown && same_picture(*w.shown, seen) && w.resolution == quality.resolution &&
        w.detail == quality.detail)
      continue;
    state_->renderer.set_line_detail(quality.detail);
    state_->renderer.draw(seen, w.width, w.height, quality.resolution);
    state_->renderer.show(0, 0, w.framebuffer.name());
    w.shown = std::move(seen);
    w.resolution = quality.resolution;
    w.detail = quality.detail;
    drawn.push_back(&w);
  }
  if (drawn.empty()) return;
  glFinish();  // what other contexts copy is there
  for (const ScreenWindow* w : drawn) {
    glfwMakeContextCurrent(w->window);
    State::show(*w);
  }
  glfwMakeContextCurrent(state_->main);
}

bool ScreenWindows::close_asked() const {
  for (const ScreenWindow& w : state_->windows) {
    if (glfwWindowShouldClose(w.window) == GLFW_TRUE) return true;
  }
  return false;
}

std::vector<Image> ScreenWindows::read() const {
  std::vector<Image> images;
  for (const ScreenWindow& w : state_->windows)
    images.push_back(read_framebuffer(w.framebuffer.name(), w.width, w.picture_height()));
  return images;
}

}  // namespace palpate
