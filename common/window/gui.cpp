#include "common/window/gui.h"

#include <algorithm>

#include <GLFW/glfw3.h>
#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>

#include "common/base/error.h"
#include "common/base/index.h"
#include "common/render/font.h"

namespace palpate {
namespace {

void map_keys(ImGuiIO& io) {
  struct Pair {
    ImGuiKey gui;
    int glfw;
  };
  static constexpr std::array<Pair, 21> kKeys{{{ImGuiKey_Tab, GLFW_KEY_TAB},
                                               {ImGuiKey_LeftArrow, GLFW_KEY_LEFT},
                                               {ImGuiKey_RightArrow, GLFW_KEY_RIGHT},
                                               {ImGuiKey_UpArrow, GLFW_KEY_UP},
                                               {ImGuiKey_DownArrow, GLFW_KEY_DOWN},
                                               {ImGuiKey_PageUp, GLFW_KEY_PAGE_UP},
                                               {ImGuiKey_PageDown, GLFW_KEY_PAGE_DOWN},
                                               {ImGuiKey_Home, GLFW_KEY_HOME},
                                               {ImGuiKey_End, GLFW_KEY_END},
                                               {ImGuiKey_Delete, GLFW_KEY_DELETE},
                                               {ImGuiKey_Backspace, GLFW_KEY_BACKSPACE},
                                               {ImGuiKey_Space, GLFW_KEY_SPACE},
                                               {ImGuiKey_Enter, GLFW_KEY_ENTER},
                                               {ImGuiKey_KeyPadEnter, GLFW_KEY_KP_ENTER},
                                               {ImGuiKey_Escape, GLFW_KEY_ESCAPE},
                                               {ImGuiKey_A, GLFW_KEY_A},
                                               {ImGuiKey_C, GLFW_KEY_C},
                                               {ImGuiKey_V, GLFW_KEY_V},
                                               {ImGuiKey_X, GLFW_KEY_X},
                                               {ImGuiKey_Y, GLFW_KEY_Y},
                                               {ImGuiKey_Z, GLFW_KEY_Z}}};
  for (const Pair& pair : kKeys) io.KeyMap[pair.gui] = pair.glfw;
}

}  // namespace

Gui::Gui(GLFWwindow* window, float text_height) : text_height_(text_height) {
  IMGUI_CHECKVERSION();
  context_ = ImGui::CreateContext();
  ImGui::SetCurrentContext(context_);
  ImGuiIO& io = ImGui::GetIO();
  io.IniFilename = nullptr;
  io.LogFilename = nullptr;
  add_font(*io.Fonts, text_height);
  map_keys(io);
  io.ClipboardUserData = window;
  io.SetClipboardTextFn = [](void* data, const char* text) {
    glfwSetClipboardString(static_cast<GLFWwindow*>(data), text);
  };
  io.GetClipboardTextFn = [](void* data) { return glfwGetClipboardString(static_cast<GLFWwindow*>(data)); };
  if (!ImGui_ImplOpenGL3_Init("#version 450 core")) {
    ImGui::DestroyContext(context_);
    throw work_error("panels cannot be drawn: libGL.so.1 cannot be loaded; install libgl1");
  }
  set_background(Background::kDark);
}

Gui::~Gui() {
  ImGui::SetCurrentContext(context_);
  ImGui_ImplOpenGL3_Shutdown();
  ImGui::DestroyContext(context_);
}

void Gui::set_background(const Background& background) {
  ImGuiStyle style;
  const bool dark = !background.is_light();
  if (dark) {
    ImGui::StyleColorsDark(&style);
    style.Colors[ImGuiCol_WindowBg] = {0.085F, 0.092F, 0.104F, 1.0F};
    style.Colors[ImGuiCol_FrameBg] = {0.165F, 0.178F, 0.200F, 1.0F};
    style.Colors[ImGuiCol_Text] = {0.90F, 0.915F, 0.935F, 1.0F};
    style.Colors[ImGuiCol_TextDisabled] = {0.58F, 0.61F, 0.65F, 1.0F};
  } else {
    ImGui::StyleColorsLight(&style);
    style.Colors[ImGuiCol_WindowBg] = {0.940F, 0.945F, 0.953F, 1.0F};
    style.Colors[ImGuiCol_FrameBg] = {1.0F, 1.0F, 1.0F, 1.0F};
    style.Colors[ImGuiCol_Text] = {0.11F, 0.12F, 0.14F, 1.0F};
    style.Colors[ImGuiCol_TextDisabled] = {0.40F, 0.43F, 0.47F, 1.0F};
  }
  const ImVec4 accent = dark ? ImVec4(0.13F, 0.50F, 0.55F, 1.0F) : ImVec4(0.30F, 0.66F, 0.70F, 1.0F);
  const ImVec4 lively{accent.x * 1.2F, accent.y * 1.2F, accent.z * 1.2F, 1.0F};
  for (const ImGuiCol slot : {ImGuiCol_SliderGrab, ImGuiCol_PlotHistogram, ImGuiCol_HeaderActive,
                              ImGuiCol_ButtonHovered, ImGuiCol_HeaderHovered}) {
    style.Colors[slot] = accent;
  }
  for (const ImGuiCol slot : {ImGuiCol_CheckMark, ImGuiCol_SliderGrabActive, ImGuiCol_ButtonActive}) {
    style.Colors[slot] = lively;
  }
  const ImVec4 quiet = dark ? ImVec4(0.20F, 0.22F, 0.25F, 1.0F) : ImVec4(0.86F, 0.875F, 0.89F, 1.0F);
  style.Colors[ImGuiCol_Button] = quiet;
  style.Colors[ImGuiCol_Header] = quiet;
  style.Colors[ImGuiCol_FrameBgHovered] = quiet;
  style.Colors[ImGuiCol_FrameBgActive] = quiet;
  style.Colors[ImGuiCol_PopupBg] = style.Colors[ImGuiCol_WindowBg];  // no words shine through
  style.WindowBorderSize = 0.0F;
  style.WindowRounding = 0.0F;
  const float em = text_height_;
  style.FrameRounding = 0.25F * em;
  style.GrabRounding = 0.25F * em;
  style.WindowPadding = {0.8F * em, 0.7F * em};
  style.FramePadding = {0.45F * em, 0.25F * em};
  style.ItemSpacing = {0.5F * em, 0.42F * em};
  style.GrabMinSize = 0.8F * em;
  ImGui::SetCurrentContext(context_);
  ImGui::GetStyle() = style;
}

void Gui::begin_frame(const std::vector<InputEvent>& events, int width, int height, double seconds) {
  ImGui::SetCurrentContext(context_);
  ImGuiIO& io = ImGui::GetIO();
  io.DisplaySize = {static_cast<float>(width), static_cast<float>(height)};
  io.DeltaTime = static_cast<float>(std::clamp(seconds, 1e-4, 1.0));
  for (const InputEvent& event : events) {
    const auto button = as_size(event.button);
    switch (event.kind) {
      case InputKind::kMove:
        io.MousePos = {static_cast<float>(event.x), static_cast<float>(event.y)};
        break;
      case InputKind::kPress:
        held_[button] = true;
        break;
      case InputKind::kRelease:
        held_[button] = false;
        break;
      case InputKind::kWheel:
        io.MouseWheelH += static_cast<float>(event.x);
        io.MouseWheel += static_cast<float>(event.y);
        break;
      case InputKind::kKeyDown:
      case InputKind::kKeyUp: {
        const int modifiers = modifiers_after(event);
        if (event.key >= 0 && event.key < static_cast<int>(std::size(io.KeysDown))) {
          io.KeysDown[event.key] = event.kind == InputKind::kKeyDown;
        }
        io.KeyCtrl = (modifiers & kModifierControl) != 0;
        io.KeyShift = (modifiers & kModifierShift) != 0;
        io.KeyAlt = (modifiers & kModifierAlt) != 0;
        break;
      }
      case InputKind::kText:
        io.AddInputCharacter(static_cast<unsigned>(event.key));
        break;
      case InputKind::kDrop:
        break;
    }
  }
  for (std::size_t i = 0; i < held_.size(); ++i) io.MouseDown[i] = held_[i];
  ImGui_ImplOpenGL3_NewFrame();
  ImGui::NewFrame();
}

void Gui::end_frame() {
  ImGui::SetCurrentContext(context_);
  ImGui::Render();
  ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
}

void Gui::end_frame(std::span<const Vec2> corners, int width, int height) {
  ImGui::SetCurrentContext(context_);
  ImGui::Render();
  ImDrawData& drawn = *ImGui::GetDrawData();
  for (const Vec2& corner : corners) {
    drawn.DisplayPos = {-static_cast<float>(corner.x), -static_cast<float>(corner.y)};
    drawn.DisplaySize = {static_cast<float>(width), static_cast<float>(height)};
    ImGui_ImplOpenGL3_RenderDrawData(&drawn);
  }
}

}  // namespace palpate
