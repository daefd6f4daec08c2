#include "common/device/driver/transport/tcp_place.h"

#include <cerrno>
#include <memory>
#include <utility>

#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>

#include "common/base/files/unique_fd.h"
#include "common/base/index.h"
#include "common/device/driver/transport/serial_line.h"

namespace palpate {
namespace {

class TcpStream final : public ByteStream {
 public:
  explicit TcpStream(UniqueFd socket) noexcept : socket_(std::move(socket)) {}

  TransferResult read(std::span<std::uint8_t> data, double seconds) noexcept override {
    const TransferStatus ready = wait_for(socket_.get(), POLLIN, steady_seconds() + seconds);
    if (ready != TransferStatus::kOk) return {ready, 0};
    const ssize_t got = ::recv(socket_.get(), data.data(), data.size(), 0);
    if (got > 0) return {TransferStatus::kOk, as_size(got)};
    const bool again = got < 0 && (errno == EAGAIN || errno == EINTR);
    return {again ? TransferStatus::kTimeout : TransferStatus::kGone, 0};
  }

  TransferResult write(std::span<const std::uint8_t> data, double seconds) noexcept override {
    std::size_t sent = 0;
    for (const double until = steady_seconds() + seconds; sent < data.size();) {
      const TransferStatus ready = wait_for(socket_.get(), POLLOUT, until);
      if (ready != TransferStatus::kOk) return {ready, sent};
      const ssize_t taken = ::send(socket_.get(), data.data() + sent, data.size() - sent, MSG_NOSIGNAL);
      if (taken >= 0) {
        sent += as_size(taken);
      } else if (errno != EAGAIN && errno != EINTR) {
        return {TransferStatus::kGone, sent};
      }
    }
    return {TransferStatus::kOk, sent};
  }

 private:
  UniqueFd socket_;
};

/// Connects to one address of a host. @return no socket where that fails or takes too long.
UniqueFd connect_to(const addrinfo& address) noexcept {
  UniqueFd socket(
      ::socket(address.ai_family, address.ai_socktype | SOCK_NONBLOCK | SOCK_CLOEXEC, address.ai_protocol));
  if (!socket) return {};
  if (::connect(socket.get(), address.ai_addr, address.ai_addrlen) != 0) {
    if (errno != EINPROGRESS ||
        wait_for(socket.get(), POLLOUT, steady_seconds() + TcpPlace::kConnectTime) != TransferStatus::kOk) {
      return {};
    }
    int problem = 0;
    socklen_t size = sizeof problem;
    if (::getsockopt(socket.get(), SOL_SOCKET, SO_ERROR, &problem, &size) != 0 || problem != 0) return {};
  }
  // Each message goes out at once.
  constexpr int kOn = 1;
  (void)::setsockopt(socket.get(), IPPROTO_TCP, TCP_NODELAY, &kOn, sizeof kOn);
  return socket;
}

}  // namespace

TcpPlace::TcpPlace(std::string host, std::uint16_t port) : host_(std::move(host)), port_(port) {}

std::string TcpPlace::name() const {
  const bool v6 = host_.find(':') != std::string::npos;
  return (v6 ? "[" + host_ + "]" : host_) + ":" + std::to_string(port_);
}

StreamOpened TcpPlace::open() {
  addrinfo wanted{};
  wanted.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  if (::getaddrinfo(host_.c_str(), std::to_string(port_).c_str(), &wanted, &found) != 0) {
    return {TransferStatus::kGone, nullptr};
  }
  const std::unique_ptr<addrinfo, decltype(&::freeaddrinfo)> addresses(found, &::freeaddrinfo);
  // "localhost" has one of either kind; more would take too long.
  constexpr int kMostAddresses = 2;
  const addrinfo* address = addresses.get();
  for (int n = 0; address != nullptr && n < kMostAddresses; address = address->ai_next, ++n) {
    if (UniqueFd socket = connect_to(*address)) {
      return {TransferStatus::kOk, std::make_unique<TcpStream>(std::move(socket))};
    }
  }
  return {TransferStatus::kGone, nullptr};
}

}  // namespace palpate
