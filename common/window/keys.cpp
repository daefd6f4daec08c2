#include "common/window/keys.h"

#include <algorithm>
#include <array>

namespace palpate {

std::span<const KeyBinding> key_bindings() noexcept {
  static constexpr std::array kBindings = std::to_array<KeyBinding>({
      {'G', 0, Command::kGrab, "G", "grab the probe at the mouse, or let it go (or hold Shift)"},
      {'K', 0, Command::kKeepLine, "K, Space", "keep the followed line, or the tracts that are drawn"},
      {'E', kModifierControl, Command::kSaveLines, "Ctrl+E", "save what is kept"},
      {'Z', kModifierControl, Command::kUndo, "Ctrl+Z",
       "undo the last edit, by the panel, the mouse or the hand"},
      {'C', 0, Command::kCorner, "C", "a corner of a box of interest at the probe; again: the one across"},
      {'R', 0, Command::kLocalLines, "R", "lines about the probe: none, a rake, a plane of seeds"},
      {'X', 0, Command::kLockX, "X", "lock the probe to the x axis, or unlock it"},
      {'Y', 0, Command::kLockY, "Y", "to the y axis"},
      {'Z', kModifierControl | kModifierShift, Command::kRedo, "Ctrl+Shift+Z", "and restore it (or Ctrl+Y)"},
      {'Y', kModifierControl, Command::kRedo, "", ""},
      {'Z', 0, Command::kLockZ, "Z", "to the z axis"},
      {key_code::kF12, 0, Command::kForceOff, "F12", "force off, at once and anywhere"},
      {'L', 0, Command::kLens, "L",
       "a lens that follows the mouse, or leave it there (or click); haptic surfaces give way"},
      {'[', 0, Command::kLensSmaller, "[  ]", "smaller and larger lens"},
      {']', 0, Command::kLensLarger, "", ""},
      {'M', 0, Command::kMenu, "M", "a menu in space, for the mouse and a tracked stylus"},
      {'V', 0, Command::kVolume, "V", "volume"},
      {'S', 0, Command::kLayout, "S", "slices next to the volume: none, one, three"},
      {key_code::kRight, 0, Command::kSliceRight, "Left, Right", "move the sagittal slice"},
      {key_code::kLeft, 0, Command::kSliceLeft, "", ""},
      {key_code::kPageUp, 0, Command::kSliceFront, "PgUp, PgDn", "the coronal slice"},
      {key_code::kPageDown, 0, Command::kSliceBack, "", ""},
      {key_code::kUp, 0, Command::kSliceUp, "Up, Down", "the axial slice"},
      {key_code::kDown, 0, Command::kSliceDown, "", ""},
      {'H', 0, Command::kHelp, "H", "this list"},
      {'/', 0, Command::kSearch, "/, Ctrl+P", "find a setting, and go to it"},
      {'P', kModifierControl, Command::kSearch, "", ""},
      {key_code::kTab, 0, Command::kPanel, "Tab", "hide the panel, or show it"},
      {key_code::kF2, 0, Command::kMessages, "F2", "all messages since the start"},
      {'F', 0, Command::kFullScreen, "F", "full screen"},
      {key_code::kEnter, 0, Command::kResetCamera, "Enter", "reset the camera"},
      {key_code::kF5, 0, Command::kLookAlongX, "F5, F6, F7",
       "view along x, y, z; again: from the other side"},
      {key_code::kF6, 0, Command::kLookAlongY, "", ""},
      {key_code::kF7, 0, Command::kLookAlongZ, "", ""},
      {' ', 0, Command::kPlay, "Space", "play the time steps; with the probe grabbed, keep the line"},
      {',', 0, Command::kStepBack, ",  .", "one time step back, or on"},
      {'.', 0, Command::kStepOn, "", ""},
      {key_code::kEscape, 0, Command::kLetGo, "Esc", "let go, cancel the job, close this list"},
      {'B', 0, Command::kColorBar, "B", "colour bar"},
      {'A', 0, Command::kAxes, "A", "axes"},
      {'T', 0, Command::kRates, "T", "rates: time for a frame"},
      {'P', 0, Command::kSavePicture, "P", "save the picture"},
      {'P', kModifierShift, Command::kExportPicture, "Shift+P", "export a picture: its size, its background"},
      {'O', kModifierControl, Command::kOpen, "Ctrl+O", "open data, or a session"},
      {'N', kModifierControl, Command::kStartPage, "Ctrl+N", "the start page: recent files and examples"},
      {'S', kModifierControl, Command::kSaveSession, "Ctrl+S",
       "save the session: what is open, and how it is seen"},
      {'S', kModifierControl | kModifierShift, Command::kSaveSessionAs, "Ctrl+Shift+S", "under another name"},
      {'W', kModifierControl, Command::kClose, "Ctrl+W", "close the data"},
      {'1', 0, Command::kMode1, "1, 2, …", "haptic mode"},
      {'2', 0, Command::kMode2, "", ""},
      {'3', 0, Command::kMode3, "", ""},
      {'4', 0, Command::kMode4, "", ""},
      {'5', 0, Command::kMode5, "", ""},
      {'6', 0, Command::kMode6, "", ""},
      {'7', 0, Command::kMode7, "", ""},
      {'8', 0, Command::kMode8, "", ""},
      {'9', 0, Command::kMode9, "", ""},
      {'Q', kModifierControl, Command::kQuit, "Ctrl+Q, Q", "quit"},
      {'Q', 0, Command::kQuit, "", ""},
  });
  return kBindings;
}

std::optional<Command> command_of(const InputEvent& event) noexcept {
  if (event.kind != InputKind::kKeyDown) return std::nullopt;
  // Caps lock and the like do not count.
  const int modifiers = event.modifiers & (kModifierShift | kModifierControl | kModifierAlt);
  const auto bindings = key_bindings();
  const auto find = [&](int with) {
    const auto found = std::find_if(bindings.begin(), bindings.end(), [&](const KeyBinding& b) {
      return b.key == event.key && b.modifiers == with;
    });
    return found == bindings.end() ? std::nullopt : std::optional(found->command);
  };
  const auto exact = find(modifiers);
  // Shift may be held to grab the probe: it takes no key's meaning away.
  return exact ? exact : find(modifiers & ~kModifierShift);
}

bool is_control_key(int key) noexcept {
  constexpr int kLeftControl = 341, kRightControl = 345;  // GLFW's numbers
  return key == kLeftControl || key == kRightControl;
}

}  // namespace palpate
