/// An OpenGL 4.5 core context without a window or display: EGL, surfaceless.
#pragma once

#include <memory>
#include <string>

namespace palpate {

/// Current on the thread that made it until destroyed. Draws into framebuffer objects only.
class OffscreenContext {
 public:
  /// @throws Error (work failed) that says which step EGL refused.
  OffscreenContext();
  ~OffscreenContext();
  OffscreenContext(const OffscreenContext&) = delete;
  OffscreenContext& operator=(const OffscreenContext&) = delete;

  void make_current();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Renderer and version of the current context, for reports.
[[nodiscard]] std::string gl_description();

/// Whether the current context draws on the processor, as its renderer's name tells.
[[nodiscard]] bool is_software_rasteriser();

}  // namespace palpate
