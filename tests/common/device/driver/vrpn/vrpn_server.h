/// The emulated VRPN server on a free port of this machine, in real time, one client at a time, on a thread.
#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>
#include <thread>

#include "tests/common/device/driver/vrpn/vrpn_emulator.h"

namespace palpate::test {

class VrpnServer {
 public:
  VrpnServer();
  ~VrpnServer();
  VrpnServer(const VrpnServer&) = delete;
  VrpnServer& operator=(const VrpnServer&) = delete;

  [[nodiscard]] std::uint16_t port() const { return port_; }
  /// Nothing is taken from the client any more.
  void stall(bool on) { stalled_ = on; }
  /// What the emulator is and became; `work` runs under the lock.
  template <class Work>
  auto with(const Work& work) {
    const std::lock_guard lock(mutex_);
    return work(vrpn_);
  }

 private:
  void serve(const std::stop_token& stop);
  void talk(const std::stop_token& stop, int client);
  [[nodiscard]] double now() const;

  std::mutex mutex_;
  VrpnEmulator vrpn_;
  double start_ = 0.0;
  int socket_ = -1;
  std::uint16_t port_ = 0;
  std::atomic<bool> stalled_{false};
  std::jthread thread_;
};

}  // namespace palpate::test
