/// What mouse and keyboard do, as plain data: it comes from the window system or from a script, and goes
/// to the panels and to the camera alike.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace palpate {

enum class InputKind : std::uint8_t {
  kMove,     ///< x, y
  kPress,    ///< button
  kRelease,  ///< button
  kWheel,    ///< x, y: notches to the right and up
  kKeyDown,  ///< key, modifiers
  kKeyUp,    ///< key, modifiers
  kText,     ///< code point in key
  kDrop      ///< files
};

enum class MouseButton : std::uint8_t { kLeft = 0, kRight = 1, kMiddle = 2 };

/// GLFW's numbers of keys that are no letters, as InputEvent::key has them.
namespace key_code {
inline constexpr int kEscape = 256, kEnter = 257, kTab = 258, kBackspace = 259, kInsert = 260, kRight = 262,
                     kLeft = 263, kDown = 264, kUp = 265, kPageUp = 266, kPageDown = 267, kF2 = 291,
                     kF5 = 294, kF6 = 295, kF7 = 296, kF12 = 301, kPadEnter = 335;
}  // namespace key_code

/// Bits of InputEvent::modifiers, as GLFW has them.
inline constexpr int kModifierShift = 1, kModifierControl = 2, kModifierAlt = 4;

/// A press that is led farther than this is a drag, and no click [pixels].
inline constexpr double kDragDistance = 4.0;

struct InputEvent {
  InputKind kind = InputKind::kMove;
  double x = 0.0;  ///< [pixels] from the left of the window
  double y = 0.0;  ///< [pixels] from its top
  MouseButton button = MouseButton::kLeft;
  int key = 0;  ///< GLFW's key number: an ASCII capital for letters, else of key_code
  int modifiers = 0;
  std::vector<std::filesystem::path> files;
};

/// The modifiers that are held after a key event. With the key of a modifier itself the window system gives
/// those that were held before it.
[[nodiscard]] int modifiers_after(const InputEvent& event) noexcept;

/// How many of the events that have come, oldest first, one frame takes. Panels see a button, a key and the
/// place of the mouse only as they are at the end of them: where a slow frame has kept a click waiting
/// together with what came after it, the press has a frame of its own, and so has the release; keys that come
/// after a press wait for the field that it may have opened. The key that
/// switches the force off waits for nothing: all are taken then.
[[nodiscard]] std::size_t events_of_frame(std::span<const InputEvent> events);

/// Whether one of them is to be answered at once: all but the mouse that goes by with no button held.
[[nodiscard]] bool wants_answer(std::span<const InputEvent> events);

/// An event at a frame.
struct ScriptedEvent {
  int frame = 0;
  InputEvent event;
  /// Label of a control of the panel, at which the mouse is then, wherever the panel has drawn it; empty: where
  /// the event says.
  std::string control = {};
  int which = 0;                    ///< of several controls of that label, from above
  double across = 0.5, down = 0.5;  ///< the place in it, from its upper left corner to the lower right one
};

}  // namespace palpate
