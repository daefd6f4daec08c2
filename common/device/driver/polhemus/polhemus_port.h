/// Where a Polhemus tracker is found and opened: on USB, or at a serial line that the user names.
#pragma once

#include <memory>
#include <string>

#include "common/device/driver/transport/byte_stream.h"
#include "common/device/driver/transport/usb.h"

namespace palpate {

enum class PolhemusFamily : std::uint8_t {
  kLiberty,  ///< Liberty and Patriot
  kFastrak
};

struct PolhemusOpened {
  TransferStatus refused = TransferStatus::kOk;  ///< kOk, and no stream: there is none
  PolhemusFamily family = PolhemusFamily::kLiberty;
  std::unique_ptr<ByteStream> commands;  ///< and their answers; null: it is not open
  std::unique_ptr<ByteStream> data;      ///< where data have a way of their own
  std::string place;                     ///< "usb 1-2.3", "/dev/ttyUSB0"
};

class PolhemusPort {
 public:
  PolhemusPort() = default;
  PolhemusPort(const PolhemusPort&) = delete;
  PolhemusPort& operator=(const PolhemusPort&) = delete;
  virtual ~PolhemusPort() = default;

  [[nodiscard]] virtual PolhemusOpened open() = 0;
  [[nodiscard]] virtual double now() const noexcept = 0;
  /// Waits for one to be plugged in, for up to `seconds`.
  virtual void await(double seconds) noexcept = 0;
  [[nodiscard]] virtual bool serial() const noexcept = 0;
};

/// The first one on a bus. `transport` outlives it.
[[nodiscard]] std::unique_ptr<PolhemusPort> polhemus_on_usb(UsbTransport& transport);
/// One at a line, which cannot be asked what it is.
[[nodiscard]] std::unique_ptr<PolhemusPort> polhemus_on_line(std::unique_ptr<StreamPlace> line,
                                                             PolhemusFamily family);

}  // namespace palpate
