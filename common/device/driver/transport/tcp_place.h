/// A server on the network: streams over TCP.
///
/// The system looks names up in its own time, which may be seconds where a name server is silent; "localhost"
/// and addresses need none.
#pragma once

#include <cstdint>
#include <string>

#include "common/device/driver/link_clock.h"
#include "common/device/driver/transport/byte_stream.h"

namespace palpate {

class TcpPlace final : public StreamPlace {
 public:
  static constexpr double kConnectTime = 0.2;  ///< [s] that one address of the host is given

  TcpPlace(std::string host, std::uint16_t port);

  [[nodiscard]] StreamOpened open() override;
  [[nodiscard]] std::string name() const override;
  [[nodiscard]] double now() const noexcept override { return clock_.now(); }
  void sleep(double seconds) noexcept override { clock_.sleep(seconds); }

 private:
  std::string host_;
  std::uint16_t port_;
  SystemLinkClock clock_;
};

}  // namespace palpate
