/// A serial line of this machine: raw bytes, 8 data bits, no parity, 1 stop bit, no flow control.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "common/device/driver/transport/byte_stream.h"
#include "common/device/driver/transport/usb.h"

namespace palpate {

/// Rates that a line can have [baud].
[[nodiscard]] const std::vector<int>& serial_rates();

class SerialLine final : public StreamPlace {
 public:
  /// @pre `baud` is one of serial_rates().
  SerialLine(std::string path, int baud);

  /// Opens the line for this program alone and throws away what waits in it.
  [[nodiscard]] StreamOpened open() override;
  [[nodiscard]] std::string name() const override { return path_; }
  [[nodiscard]] double now() const noexcept override;
  void sleep(double seconds) noexcept override;

 private:
  std::string path_;
  unsigned speed_ = 0;  ///< as termios has it
};

/// The value of `baud=`, for `driver`. @throws Error (usage), which names the rates that there are.
[[nodiscard]] int baud_of(std::string_view driver, const std::string& value);

/// [s] of CLOCK_MONOTONIC.
[[nodiscard]] double steady_seconds() noexcept;

/// Waits until `file` can be read (POLLIN) or written to (POLLOUT), as `events` of poll() says, at least one
/// look and no later than `until` [s of steady_seconds()].
/// @return kGone: the other side has closed, or nobody was there; what came before that is still read.
[[nodiscard]] TransferStatus wait_for(int file, short events, double until) noexcept;

}  // namespace palpate
