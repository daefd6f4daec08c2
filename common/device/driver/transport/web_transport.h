/// A service that speaks WebSocket (RFC 6455), as drivers see it: whole text messages both ways. Modules put
/// a library behind it, tests a fake with a virtual clock.
///
/// Nothing that the other side does takes longer than the time that is given or more memory than
/// kLongestMessage: longer messages end the connection.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "common/device/driver/link_clock.h"
#include "common/device/driver/transport/usb.h"

namespace palpate {

struct WebAddress {
  std::string host;
  std::uint16_t port = 0;
};

/// Closed when this is deleted. One thread.
class WebConnection {
 public:
  static constexpr std::size_t kLongestMessage = 65536;  ///< [bytes]

  WebConnection() = default;
  WebConnection(const WebConnection&) = delete;
  WebConnection& operator=(const WebConnection&) = delete;
  virtual ~WebConnection() = default;

  /// @return anything but kOk ends the connection.
  virtual TransferStatus send(std::string_view message, double seconds) noexcept = 0;
  /// The next message; kTimeout: none came, which ends nothing.
  virtual TransferStatus receive(std::string& message, double seconds) noexcept = 0;
};

struct WebOpened {
  TransferStatus status = TransferStatus::kFailed;
  std::unique_ptr<WebConnection> connection;  ///< where the status is kOk
};

class WebTransport : public LinkClock {
 public:
  [[nodiscard]] virtual WebOpened open(const WebAddress& address, double seconds) noexcept = 0;
  /// What HTTP GET brings, of a few kB at most; nothing where it brings nothing in time.
  [[nodiscard]] virtual std::optional<std::string> get(const WebAddress& address, const std::string& path,
                                                       double seconds) noexcept = 0;
};

[[nodiscard]] std::unique_ptr<WebTransport> make_beast_transport();

}  // namespace palpate
