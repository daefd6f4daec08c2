#include "common/render/gl/context.h"

#include <algorithm>
#include <array>
#include <string_view>

#include <epoxy/egl.h>
#include <epoxy/gl.h>

#include "common/base/error.h"
#include "common/base/index.h"
#include "common/base/ledger.h"

namespace palpate {

struct OffscreenContext::State {
  EGLDisplay display = EGL_NO_DISPLAY;
  EGLContext context = EGL_NO_CONTEXT;
};

namespace {

// Mesa's surfaceless platform first: it needs neither a display nor a device file. Then the first device
// of the driver, as other vendors offer it.
EGLDisplay open_display() {
  if (epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_MESA_platform_surfaceless")) {
    EGLDisplay display =
        eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
    if (display != EGL_NO_DISPLAY && eglInitialize(display, nullptr, nullptr)) return display;
  }
  if (epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_platform_device")) {
    constexpr EGLint kMaxDevices = 8;
    std::array<EGLDeviceEXT, kMaxDevices> devices{};
    EGLint count = 0;
    eglQueryDevicesEXT(kMaxDevices, devices.data(), &count);
    for (EGLint i = 0; i < count; ++i) {
      EGLDisplay display = eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, devices[as_size(i)], nullptr);
      if (display != EGL_NO_DISPLAY && eglInitialize(display, nullptr, nullptr)) return display;
    }
  }
  throw work_error(
      "cannot draw without a display: EGL offers neither a surfaceless nor a device platform; install "
      "libegl1 and libgl1-mesa-dri");
}

std::string text_of_driver(GLenum name) {
  const GLubyte* value = glGetString(name);
  return value == nullptr ? std::string("unknown") : std::string(reinterpret_cast<const char*>(value));
}

}  // namespace

OffscreenContext::OffscreenContext() : state_(std::make_unique<State>()) {
  const Work work("OpenGL off screen", "a context to draw in");
  state_->display = open_display();
  constexpr std::array<EGLint, 5> kConfig{EGL_SURFACE_TYPE, 0, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE};
  constexpr std::array<EGLint, 7> kContext{EGL_CONTEXT_MAJOR_VERSION,
                                           4,
                                           EGL_CONTEXT_MINOR_VERSION,
                                           5,
                                           EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                           EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                           EGL_NONE};
  EGLConfig config = nullptr;
  EGLint count = 0;
  if (!eglBindAPI(EGL_OPENGL_API) || !eglChooseConfig(state_->display, kConfig.data(), &config, 1, &count) ||
      count == 0) {
    throw work_error("cannot draw without a display: EGL has no configuration for desktop OpenGL");
  }
  state_->context = eglCreateContext(state_->display, config, EGL_NO_CONTEXT, kContext.data());
  if (state_->context == EGL_NO_CONTEXT) {
    throw work_error("cannot draw without a display: the driver has no OpenGL 4.5 core context");
  }
  make_current();
}

OffscreenContext::~OffscreenContext() {
  eglMakeCurrent(state_->display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  if (state_->context != EGL_NO_CONTEXT) eglDestroyContext(state_->display, state_->context);
  // The display is shared by all of the process and stays initialised: terminating it here would pull
  // it away from other contexts.
}

void OffscreenContext::make_current() {
  if (!eglMakeCurrent(state_->display, EGL_NO_SURFACE, EGL_NO_SURFACE, state_->context)) {
    throw work_error("cannot draw without a display: EGL refused the context");
  }
}

std::string gl_description() {
  return text_of_driver(GL_RENDERER) + ", OpenGL " + text_of_driver(GL_VERSION);
}

bool is_software_rasteriser() {
  // Mesa's, Google's and Microsoft's.
  constexpr std::array<std::string_view, 6> kNames{"llvmpipe",    "softpipe", "swrast",
                                                   "SwiftShader", "Software", "Basic Render"};
  const std::string renderer = text_of_driver(GL_RENDERER);
  return std::any_of(kNames.begin(), kNames.end(),
                     [&](std::string_view name) { return renderer.find(name) != std::string::npos; });
}

}  // namespace palpate
