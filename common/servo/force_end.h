/// What ends or stops the program takes the force away first.
///
/// While one ForceEnd lives, every signal that would end the program (a closed terminal, a crash, abort(), an
/// exception that nobody caught) or stop it (Ctrl-Z) is handled so: from now on no link shows a force; the
/// threads of the links, which are at work all the while, tell their devices so; and once all have, or after
/// kLongest, the program ends or stops as it would have. After Ctrl-Z it goes on without force until it is
/// armed again (program_stops(), which the servo looks at).
///
/// Signals that are ignored stay so. One that has a handler, as SIGINT has, keeps it, and that handler calls
/// hold_forces(); crashes are handled whoever else handles them next. What nobody can handle, SIGKILL and
/// SIGSTOP, is for the device's own time limit and for Guardian (device/driver/transport/guardian.h).
///
/// A crash of a link's own thread leaves nobody to tell its device: that is for these two as well.
#pragma once

#include <atomic>
#include <cstdint>

namespace palpate {

/// No link shows a force until release_forces(), once for each call. Signal handlers included.
void hold_forces() noexcept;
void release_forces() noexcept;
/// How often the program was stopped and went on.
[[nodiscard]] std::uint64_t program_stops() noexcept;

/// One link's.
class ForceEnd {
 public:
  static constexpr double kLongest = 0.040;  ///< [s] for which the end waits
  static constexpr int kMost = 16;           ///< links that are waited for

  ForceEnd();
  ~ForceEnd();
  ForceEnd(const ForceEnd&) = delete;
  ForceEnd& operator=(const ForceEnd&) = delete;

  // The link's thread, around a round. @rt Safe.

  /// Before a round that shows a force: whether it may.
  [[nodiscard]] bool may_show() noexcept;
  /// After a round that showed none.
  void rested() noexcept;

  /// Signals that come from outside go to other threads than the calling one, which is the link's.
  static void leave_signals_to_others() noexcept;

 private:
  std::atomic<int>*
      shows_;  ///< rounds without force until it is known that none is shown; null: not waited for
};

}  // namespace palpate
