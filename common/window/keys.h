/// Keys and what they do; one table serves the window and its cheat sheet.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "common/window/input_event.h"

namespace palpate {

enum class Command : std::uint8_t {
  kHelp,
  kSearch,    ///< for a setting
  kMessages,  ///< all that were said
  kPanel,     ///< shows or hides it
  kFullScreen,
  kResetCamera,
  kLookAlongX,  ///< again: from the other side
  kLookAlongY,
  kLookAlongZ,
  kPlay,
  kStepBack,  ///< in time
  kStepOn,
  kLetGo,
  kQuit,
  kColorBar,
  kAxes,
  kRates,
  kSavePicture,
  kExportPicture,  ///< in another size, on another background
  kOpen,
  kSaveSession,
  kSaveSessionAs,
  kStartPage,
  kClose,  ///< what is open
  kGrab,
  kKeepLine,
  kSaveLines,
  kUndo,
  kRedo,
  kLocalLines,
  kCorner,  ///< of the region of interest, at the probe
  kLockX,
  kLockY,
  kLockZ,
  kForceOff,
  kLens,  ///< a lens that the mouse moves
  kLensSmaller,
  kLensLarger,
  kMenu,        ///< in space
  kVolume,      ///< shows or hides the volume
  kLayout,      ///< slices beside it: none, one, three
  kSliceRight,  ///< the slice across x, one voxel
  kSliceLeft,
  kSliceFront,
  kSliceBack,
  kSliceUp,
  kSliceDown,
  kMode1,  ///< and so on
  kMode2,
  kMode3,
  kMode4,
  kMode5,
  kMode6,
  kMode7,
  kMode8,
  kMode9
};
inline constexpr int kModeKeys = 9;

struct KeyBinding {
  int key;        ///< GLFW's number
  int modifiers;  ///< InputEvent::modifiers, exactly
  Command command;
  const char* name;  ///< "Ctrl+S"; empty: not in the cheat sheet
  const char* what;  ///< "save the session"
};

[[nodiscard]] std::span<const KeyBinding> key_bindings() noexcept;

/// What a key press asks for.
[[nodiscard]] std::optional<Command> command_of(const InputEvent& event) noexcept;

/// Either Ctrl key. @param key of an input event.
[[nodiscard]] bool is_control_key(int key) noexcept;

}  // namespace palpate
