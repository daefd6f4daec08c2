#include "apps/workbench/force_keys.h"

#include <array>
#include <string_view>

#include <poll.h>
#include <unistd.h>

#include "common/base/index.h"

namespace palpate {

ForceKeys::ForceKeys() {
  termios now{};
  if (isatty(STDIN_FILENO) == 0 || tcgetattr(STDIN_FILENO, &now) != 0) return;
  const termios before = now;
  now.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);  // Ctrl-C still interrupts
  now.c_cc[VMIN] = 0;
  now.c_cc[VTIME] = 0;
  if (tcsetattr(STDIN_FILENO, TCSANOW, &now) == 0) before_ = before;
}

ForceKeys::~ForceKeys() {
  if (before_) (void)tcsetattr(STDIN_FILENO, TCSANOW, &*before_);
}

ForceKeys::Key ForceKeys::pressed() {
  if (!before_) return Key::kNone;
  Key key = Key::kNone;
  for (pollfd waiting{STDIN_FILENO, POLLIN, 0}; poll(&waiting, 1, 0) > 0;) {
    std::array<char, 64> bytes{};
    const ssize_t count = read(STDIN_FILENO, bytes.data(), bytes.size());
    if (count <= 0) break;
    const std::string_view typed(bytes.data(), as_size(count));
    // Keys with a name, F12 among them, come as several bytes.
    if (typed == "q" || typed == "Q") {
      key = key == Key::kForceOff ? key : Key::kQuit;
    } else if (typed == "a" || typed == "A") {
      key = key == Key::kForceOff ? key : Key::kArm;
    } else {
      key = Key::kForceOff;
    }
  }
  return key;
}

}  // namespace palpate
