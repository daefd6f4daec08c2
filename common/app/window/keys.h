/// Keys and what they do; one table serves the window and its cheat sheet.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "common/app/window/input_event.h"

namespace palpate {

enum class Command : std::uint8_t {
  kHelp,
  kFullScreen,
  kResetCamera,
  kPlay,
  kLetGo,
  kQuit,
  kColorBar,
  kAxes,
  kRates,
  kSavePicture,
  kSaveSession
};

struct KeyBinding {
  int key;        ///< GLFW's number
  int modifiers;  ///< InputEvent::modifiers, exactly
  Command command;
  const char* name;  ///< "Ctrl+S"
  const char* what;  ///< "save the session"
};

[[nodiscard]] std::span<const KeyBinding> key_bindings() noexcept;

/// What a key press asks for.
[[nodiscard]] std::optional<Command> command_of(const InputEvent& event) noexcept;

}  // namespace palpate
