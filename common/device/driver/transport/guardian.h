/// A small process that outlives this one for a moment: however this program ends, kill -9 included, it writes
/// what it was given to a device that has no time limit of its own.
///
/// It is the helper program palpate-guardian, so that none of this program's memory is kept with it. It waits
/// for the end of a pipe that this process alone holds, out of reach of the signals of a terminal. Where it is
/// let go of it ends without a word.
///
/// A program that stands still (SIGSTOP) has not ended: that is no case of this.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <sys/types.h>

namespace palpate {

class Guardian {
 public:
  Guardian() = default;  ///< none
  /// @param line what it opens: {"usb", "/dev/bus/usb/001/004", interface, endpoint}, of which it claims the
  /// interface once this process no longer has it, or {"file", PATH}. @param words written one after another.
  Guardian(const std::vector<std::string>& line, std::span<const std::uint8_t> word, int times);
  ~Guardian();
  Guardian(Guardian&& other) noexcept;
  Guardian& operator=(Guardian&& other) noexcept;

  /// Whether it was started, and could open its line.
  [[nodiscard]] bool watches() const noexcept { return process_ > 0; }

 private:
  void let_go() noexcept;

  pid_t process_ = 0;
  int pipe_ = -1;  ///< its other end
};

}  // namespace palpate
