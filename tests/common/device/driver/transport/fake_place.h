/// A VRPN server at the other end of a stream in this process, time as the test says: what a network does
/// wrong can be made to happen.
#pragma once

#include <cstdint>
#include <deque>
#include <random>
#include <string>

#include "common/device/driver/transport/byte_stream.h"
#include "tests/common/device/driver/vrpn/vrpn_emulator.h"

namespace palpate::test {

struct StreamFaults {
  double split = 0.0;      ///< a read gets a few bytes only
  double late = 0.0;       ///< what is said arrives `lateness` later
  double lateness = 0.05;  ///< [s]
  double corrupt = 0.0;    ///< a byte of what is read is another
  double reset = 0.0;      ///< the connection ends
  double full = 0.0;       ///< a write is taken in part only
};

class FakePlace final : public StreamPlace {
 public:
  explicit FakePlace(VrpnEmulator& server) : server_(server) {}

  bool listens = true;
  bool stalled = false;  ///< nothing passes, either way
  StreamFaults faults;
  std::mt19937_64 random{4};
  [[nodiscard]] int connections() const { return connections_; }
  [[nodiscard]] int opened() const { return opened_; }

  [[nodiscard]] StreamOpened open() override;
  [[nodiscard]] std::string name() const override { return "lab:3883"; }
  [[nodiscard]] double now() const noexcept override { return now_; }
  void sleep(double seconds) noexcept override;

 private:
  class Stream;
  bool happens(double probability) { return std::uniform_real_distribution<double>()(random) < probability; }

  VrpnEmulator& server_;
  double now_ = 0.0;
  int connections_ = 0, opened_ = 0;
};

}  // namespace palpate::test
