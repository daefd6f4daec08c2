/// The keyboard of the terminal as a switch of the force: F12, or any other key, switches it off.
#pragma once

#include <optional>

#include <termios.h>

namespace palpate {

class ForceKeys {
 public:
  enum class Key { kNone, kForceOff, kArm, kQuit };

  /// Takes single keys from the terminal, without showing them, where standard input is one.
  ForceKeys();
  /// Leaves the terminal as it was.
  ~ForceKeys();
  ForceKeys(const ForceKeys&) = delete;
  ForceKeys& operator=(const ForceKeys&) = delete;

  /// Whether there is a terminal.
  [[nodiscard]] bool listening() const noexcept { return before_.has_value(); }
  /// What was pressed since the last call: `a` arms, `q` quits, anything else switches off, and wins over
  /// both.
  [[nodiscard]] Key pressed();

 private:
  std::optional<termios> before_;
};

}  // namespace palpate
