/// The functions of GLFW that are called here, each handed on to the library: it is opened, and with it the window system,
/// where the first of them is called, so that what draws no window maps neither. Nothing links the library itself; a
/// function that has no row here is missed by the linker.
///
/// Errors: all throw Error (work failed) where there is no library, as none can be called before glfwInit().

#include <array>

#include <GLFW/glfw3.h>

#include "common/base/files/shared_library.h"
#include "common/base/ledger.h"

namespace palpate {
namespace {

SharedLibrary opened_glfw() {
  const Work work("window system", "a window to draw in");
  constexpr std::array<const char*, 1> kNames{"libglfw.so.3"};
  return {"", kNames, "install the package libglfw3"};
}

template <class Function>
Function* of_glfw(const char* name) {
  static const SharedLibrary kLibrary = opened_glfw();
  Function* function = nullptr;
  kLibrary.require(function, name);
  return function;
}

}  // namespace
}  // namespace palpate

#define PALPATE_GLFW(result, name, parameters, arguments)                   \
  result name parameters {                                                  \
    static auto* const kFunction = palpate::of_glfw<decltype(name)>(#name); \
    return kFunction arguments;                                             \
  }

extern "C" {

PALPATE_GLFW(int, glfwInit, (), ())
PALPATE_GLFW(void, glfwTerminate, (), ())
PALPATE_GLFW(int, glfwGetError, (const char** description), (description))
PALPATE_GLFW(GLFWmonitor**, glfwGetMonitors, (int* count), (count))
PALPATE_GLFW(GLFWmonitor*, glfwGetPrimaryMonitor, (), ())
PALPATE_GLFW(void, glfwGetMonitorPos, (GLFWmonitor * monitor, int* xpos, int* ypos), (monitor, xpos, ypos))
PALPATE_GLFW(void, glfwGetMonitorWorkarea,
             (GLFWmonitor * monitor, int* xpos, int* ypos, int* width, int* height),
             (monitor, xpos, ypos, width, height))
PALPATE_GLFW(const GLFWvidmode*, glfwGetVideoMode, (GLFWmonitor * monitor), (monitor))
PALPATE_GLFW(void, glfwWindowHint, (int hint, int value), (hint, value))
PALPATE_GLFW(GLFWwindow*, glfwCreateWindow,
             (int width, int height, const char* title, GLFWmonitor* monitor, GLFWwindow* share),
             (width, height, title, monitor, share))
PALPATE_GLFW(void, glfwDestroyWindow, (GLFWwindow * window), (window))
PALPATE_GLFW(int, glfwWindowShouldClose, (GLFWwindow * window), (window))
PALPATE_GLFW(void, glfwSetWindowShouldClose, (GLFWwindow * window, int value), (window, value))
PALPATE_GLFW(void, glfwSetWindowTitle, (GLFWwindow * window, const char* title), (window, title))
PALPATE_GLFW(void, glfwGetWindowPos, (GLFWwindow * window, int* xpos, int* ypos), (window, xpos, ypos))
PALPATE_GLFW(void, glfwSetWindowPos, (GLFWwindow * window, int xpos, int ypos), (window, xpos, ypos))
PALPATE_GLFW(void, glfwGetWindowSize, (GLFWwindow * window, int* width, int* height), (window, width, height))
PALPATE_GLFW(void, glfwGetFramebufferSize, (GLFWwindow * window, int* width, int* height),
             (window, width, height))
PALPATE_GLFW(void, glfwGetWindowContentScale, (GLFWwindow * window, float* xscale, float* yscale),
             (window, xscale, yscale))
PALPATE_GLFW(void, glfwShowWindow, (GLFWwindow * window), (window))
PALPATE_GLFW(GLFWmonitor*, glfwGetWindowMonitor, (GLFWwindow * window), (window))
PALPATE_GLFW(void, glfwSetWindowMonitor,
             (GLFWwindow * window, GLFWmonitor* monitor, int xpos, int ypos, int width, int height,
              int refreshRate),
             (window, monitor, xpos, ypos, width, height, refreshRate))
PALPATE_GLFW(void, glfwSetWindowUserPointer, (GLFWwindow * window, void* pointer), (window, pointer))
PALPATE_GLFW(void*, glfwGetWindowUserPointer, (GLFWwindow * window), (window))
PALPATE_GLFW(GLFWwindowposfun, glfwSetWindowPosCallback, (GLFWwindow * window, GLFWwindowposfun callback),
             (window, callback))
PALPATE_GLFW(GLFWwindowrefreshfun, glfwSetWindowRefreshCallback,
             (GLFWwindow * window, GLFWwindowrefreshfun callback), (window, callback))
PALPATE_GLFW(GLFWframebuffersizefun, glfwSetFramebufferSizeCallback,
             (GLFWwindow * window, GLFWframebuffersizefun callback), (window, callback))
PALPATE_GLFW(void, glfwPollEvents, (), ())
PALPATE_GLFW(void, glfwWaitEventsTimeout, (double timeout), (timeout))
PALPATE_GLFW(void, glfwPostEmptyEvent, (), ())
PALPATE_GLFW(GLFWkeyfun, glfwSetKeyCallback, (GLFWwindow * window, GLFWkeyfun callback), (window, callback))
PALPATE_GLFW(GLFWcharfun, glfwSetCharCallback, (GLFWwindow * window, GLFWcharfun callback),
             (window, callback))
PALPATE_GLFW(GLFWmousebuttonfun, glfwSetMouseButtonCallback,
             (GLFWwindow * window, GLFWmousebuttonfun callback), (window, callback))
PALPATE_GLFW(GLFWcursorposfun, glfwSetCursorPosCallback, (GLFWwindow * window, GLFWcursorposfun callback),
             (window, callback))
PALPATE_GLFW(GLFWscrollfun, glfwSetScrollCallback, (GLFWwindow * window, GLFWscrollfun callback),
             (window, callback))
PALPATE_GLFW(GLFWdropfun, glfwSetDropCallback, (GLFWwindow * window, GLFWdropfun callback),
             (window, callback))
PALPATE_GLFW(void, glfwSetClipboardString, (GLFWwindow * window, const char* string), (window, string))
PALPATE_GLFW(const char*, glfwGetClipboardString, (GLFWwindow * window), (window))
PALPATE_GLFW(double, glfwGetTime, (), ())
PALPATE_GLFW(void, glfwMakeContextCurrent, (GLFWwindow * window), (window))
PALPATE_GLFW(void, glfwSwapBuffers, (GLFWwindow * window), (window))
PALPATE_GLFW(void, glfwSwapInterval, (int interval), (interval))

}  // extern "C"
