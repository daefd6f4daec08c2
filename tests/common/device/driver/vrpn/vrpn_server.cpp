#include "tests/common/device/driver/vrpn/vrpn_server.h"

#include <array>
#include <chrono>

#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include "tests/common/device/driver/transport/loopback.h"

namespace palpate::test {
namespace {

double steady() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace

VrpnServer::VrpnServer() : start_(steady()) {
  socket_ = listen_on_loopback(port_);
  thread_ = std::jthread([this](const std::stop_token& stop) { serve(stop); });
}

VrpnServer::~VrpnServer() {
  thread_.request_stop();
  thread_.join();
  ::close(socket_);
}

double VrpnServer::now() const { return steady() - start_; }

void VrpnServer::serve(const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    pollfd poll{socket_, POLLIN, 0};
    if (::poll(&poll, 1, 20) <= 0) continue;
    const int client = ::accept(socket_, nullptr, nullptr);
    if (client < 0) continue;
    with([&](VrpnEmulator& vrpn) { vrpn.connect(now()); });
    talk(stop, client);
    with([&](VrpnEmulator& vrpn) { vrpn.leave(now()); });
    ::close(client);
  }
}

void VrpnServer::talk(const std::stop_token& stop, int client) {
  while (!stop.stop_requested()) {
    VrpnEmulator::Bytes said;
    with([&](VrpnEmulator& vrpn) {
      vrpn.arm.set_target(wandering(now()));
      vrpn.advance(now(), said);
    });
    for (std::size_t at = 0; at < said.size();) {
      const ssize_t sent = ::send(client, said.data() + at, said.size() - at, MSG_NOSIGNAL);
      if (sent <= 0) return;
      at += static_cast<std::size_t>(sent);
    }
    pollfd poll{client, POLLIN, 0};
    if (stalled_ || ::poll(&poll, 1, 2) <= 0) {
      if (stalled_) std::this_thread::sleep_for(std::chrono::milliseconds(2));
      continue;
    }
    std::array<std::uint8_t, 4096> part{};
    const ssize_t got = ::recv(client, part.data(), part.size(), 0);
    if (got <= 0) return;
    with([&](VrpnEmulator& vrpn) { vrpn.take(now(), {part.begin(), part.begin() + got}); });
  }
}

}  // namespace palpate::test
