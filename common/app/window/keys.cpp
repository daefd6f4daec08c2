#include "common/app/window/keys.h"

#include <algorithm>
#include <array>

namespace palpate {

std::span<const KeyBinding> key_bindings() noexcept {
  constexpr int kEscape = 256, kEnter = 257;
  static constexpr std::array<KeyBinding, 11> kBindings{{
      {'H', 0, Command::kHelp, "H", "this list"},
      {'F', 0, Command::kFullScreen, "F", "full screen"},
      {kEnter, 0, Command::kResetCamera, "Enter", "reset the camera"},
      {' ', 0, Command::kPlay, "Space", "play the time steps"},
      {kEscape, 0, Command::kLetGo, "Esc", "let go, cancel the job, close this list"},
      {'B', 0, Command::kColorBar, "B", "colour bar"},
      {'A', 0, Command::kAxes, "A", "axes"},
      {'T', 0, Command::kRates, "T", "rates: time for a frame"},
      {'P', 0, Command::kSavePicture, "P", "save the picture"},
      {'S', kModifierControl, Command::kSaveSession, "Ctrl+S", "save the session"},
      {'Q', 0, Command::kQuit, "Q", "quit"},
  }};
  return kBindings;
}

std::optional<Command> command_of(const InputEvent& event) noexcept {
  if (event.kind != InputKind::kKeyDown) return std::nullopt;
  // Caps lock and the like do not count.
  const int modifiers = event.modifiers & (kModifierShift | kModifierControl | kModifierAlt);
  const auto bindings = key_bindings();
  const auto found = std::find_if(bindings.begin(), bindings.end(), [&](const KeyBinding& b) {
    return b.key == event.key && b.modifiers == modifiers;
  });
  return found == bindings.end() ? std::nullopt : std::optional(found->command);
}

}  // namespace palpate
