/// Where a Polhemus tracker is found and opened: on USB, or at a serial line that the user names.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <utility>

#include "common/device/driver/transport/byte_stream.h"
#include "common/device/driver/transport/usb.h"
#include "common/device/driver_link.h"
#include "common/math/vec.h"

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

// What the user says of a Polhemus tracker.

struct PolhemusSettings {
  /// The half of the room that sensors are in, seen from the transmitter: the tracker cannot tell a place
  /// from the one opposite.
  Vec3 hemisphere{1.0, 0.0, 0.0};
  std::string port;  ///< a serial line; empty: USB
  int baud = 115200;
  PolhemusFamily family = PolhemusFamily::kFastrak;  ///< at a serial line
};

/// The options of `--device polhemus:port=/dev/ttyUSB0,baud=115200,model=fastrak,hemisphere=+x`.
/// @throws Error (usage).
[[nodiscard]] PolhemusSettings polhemus_settings(const DriverOptions& options);
[[nodiscard]] std::string polhemus_help();
/// Where these settings say that it is. `transport` outlives it.
[[nodiscard]] std::unique_ptr<PolhemusPort> polhemus_port(const PolhemusSettings& settings,
                                                          UsbTransport& transport);

class UsbStream final : public ByteStream {
 public:
  UsbStream(std::shared_ptr<UsbConnection> connection, const UsbEndpoint& out, const UsbEndpoint& in)
      : connection_(std::move(connection)), out_(out), in_(in) {}

  /// @pre `data` has room for a packet.
  TransferResult read(std::span<std::uint8_t> data, double seconds) noexcept override {
    TransferResult got = connection_->read(in_, data, seconds);
    // A transfer that would have taken more has what came until its time was over.
    if (got.status == TransferStatus::kTimeout && got.bytes > 0) got.status = TransferStatus::kOk;
    // An empty packet is nothing.
    if (got.ok() && got.bytes == 0) got.status = TransferStatus::kTimeout;
    return got;
  }
  TransferResult write(std::span<const std::uint8_t> data, double seconds) noexcept override {
    TransferResult sent = connection_->write(out_, data, seconds);
    if (sent.ok() && sent.bytes < data.size()) sent.status = TransferStatus::kTimeout;
    return sent;
  }

 private:
  std::shared_ptr<UsbConnection> connection_;
  UsbEndpoint out_, in_;
};

}  // namespace palpate
