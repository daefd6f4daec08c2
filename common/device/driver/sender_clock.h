/// When something was sent, by this machine's clock, from the stamp of another one's.
///
///   t = s + o,   o = the least of (arrival - s) so far, grown by kDrift a second
///
/// the packet that took least time tells how the clocks differ, but for that time; others are older by what they
/// took more. So two packets that were made 10 ms apart and come together are 10 ms apart.
///
/// Stamps that do not go on while packets come are none; so are those that jump, of a clock that was set. Then a
/// packet is of its arrival.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

namespace palpate {

class SenderClock {
 public:
  static constexpr double kDrift = 1e-4;      ///< by which two clocks run apart at most
  static constexpr double kMostDelay = 0.25;  ///< [s] a packet that seems older shows a clock that was set

  void reset() noexcept { *this = SenderClock(); }

  /// @param sent by the sender's clock, @param arrived by ours [s]. @return never later than `arrived`, nor
  /// earlier than the last one.
  [[nodiscard]] double local(double sent, double arrived) noexcept {
    const bool goes_on = last_ && sent > last_->sent;
    // A coarse clock stands still for many packets, each some time after the other.
    constexpr double kApart = 0.001;  // [s]
    if (last_ && sent == last_->sent && arrived > last_->arrived + kApart) coarse_ = true;
    if (!std::isfinite(sent)) sent = arrived;
    double offset = arrived - sent;
    if (goes_on && !coarse_) {
      offset = std::min(last_->offset + kDrift * (arrived - last_->arrived), offset);
      if (arrived - (sent + offset) > kMostDelay) offset = arrived - sent;
    }
    const double time = coarse_ ? arrived : std::min(sent + offset, arrived);
    const double local = last_ ? std::clamp(time, std::min(last_->local, arrived), arrived) : time;
    last_ = {sent, arrived, offset, local};
    return local;
  }

 private:
  struct Packet {
    double sent, arrived, offset, local;  ///< [s]
  };
  std::optional<Packet> last_;
  bool coarse_ = false;
};

}  // namespace palpate
