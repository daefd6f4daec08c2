/// What must still be done where the program is ended in the middle of its work: no force on a device, the
/// end of a recording.
#pragma once

#include <functional>

namespace palpate {

/// Registered while it lives. Its destructor waits while last acts run.
class LastAct {
 public:
  /// @param act called by run_last_acts() on the thread of that, while all others are at work. Takes a tenth
  /// of a second at the most, whatever hangs, and throws nothing.
  explicit LastAct(std::function<void()> act);
  ~LastAct();
  LastAct(const LastAct&) = delete;
  LastAct& operator=(const LastAct&) = delete;

 private:
  std::function<void()> act_;
  friend void run_last_acts();
};

/// Calls every act, the latest one first: what was made later uses what was made before. For who ends the
/// program next.
void run_last_acts();

}  // namespace palpate
