#include "common/device/driver/tcp_place.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <memory>
#include <utility>

#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>

#include "common/base/unique_fd.h"

namespace palpate {
namespace {

/// Waits until the socket can do `what`. kGone: the other side has closed, or nobody was there.
TransferStatus wait_for(int socket, short what, double seconds) noexcept {
  const SystemLinkClock clock;
  for (const double until = clock.now() + seconds;;) {
    pollfd line{.fd = socket, .events = what, .revents = 0};
    const double left = std::max(until - clock.now(), 0.0);
    const int ready = ::poll(&line, 1, static_cast<int>(std::ceil(1e3 * left)));
    // What came before the other side closed is still read.
    if (ready > 0) return (line.revents & what) != 0 ? TransferStatus::kOk : TransferStatus::kGone;
    if (ready == 0) return TransferStatus::kTimeout;
    if (errno != EINTR) return TransferStatus::kFailed;
  }
}

class TcpStream final : public ByteStream {
 public:
  explicit TcpStream(UniqueFd socket) noexcept : socket_(std::move(socket)) {}

  TransferResult read(std::span<std::uint8_t> data, double seconds) noexcept override {
    const TransferStatus ready = wait_for(socket_.get(), POLLIN, seconds);
    if (ready != TransferStatus::kOk) return {ready, 0};
    const ssize_t got = ::recv(socket_.get(), data.data(), data.size(), 0);
    if (got > 0) return {TransferStatus::kOk, static_cast<std::size_t>(got)};
    const bool again = got < 0 && (errno == EAGAIN || errno == EINTR);
    return {again ? TransferStatus::kTimeout : TransferStatus::kGone, 0};
  }

  TransferResult write(std::span<const std::uint8_t> data, double seconds) noexcept override {
    const SystemLinkClock clock;
    std::size_t sent = 0;
    for (const double until = clock.now() + seconds; sent < data.size();) {
      const TransferStatus ready = wait_for(socket_.get(), POLLOUT, until - clock.now());
      if (ready != TransferStatus::kOk) return {ready, sent};
      const ssize_t taken = ::send(socket_.get(), data.data() + sent, data.size() - sent, MSG_NOSIGNAL);
      if (taken >= 0) {
        sent += static_cast<std::size_t>(taken);
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
        wait_for(socket.get(), POLLOUT, TcpPlace::kConnectTime) != TransferStatus::kOk) {
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
