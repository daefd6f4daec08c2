/// A service in this process, messages both ways, time as the test says: what a network does wrong can be
/// made to happen.
#pragma once

#include <deque>
#include <random>
#include <string>
#include <utility>

#include "common/device/driver/transport/web_transport.h"
#include "tests/common/device/driver/inverse3/haply_emulator.h"

namespace palpate::test {

struct WebFaults {
  double lost = 0.0;       ///< a state never comes
  double late = 0.0;       ///< it comes `lateness` later, and what follows it, too
  double lateness = 0.05;  ///< [s]
  double corrupt = 0.0;    ///< a byte of a state is another
  double cut = 0.0;        ///< a state ends early
  double doubled = 0.0;    ///< a state comes twice
  double reset = 0.0;      ///< the connection ends
};

class FakeWeb final : public WebTransport {
 public:
  explicit FakeWeb(HaplyEmulator& service) : service_(service) {}

  bool listens = true;
  bool tells_version = true;
  bool flood = false;  ///< it talks without being asked
  std::string says;    ///< instead of any state; empty: the truth
  WebFaults faults;
  std::mt19937_64 random{3};

  [[nodiscard]] int connections() const { return connections_; }
  [[nodiscard]] int opened() const { return opened_; }

  [[nodiscard]] double now() const noexcept override { return now_; }
  void sleep(double seconds) noexcept override {
    if (seconds > 0.0) now_ += seconds;
    service_.advance(now_);
  }
  WebOpened open(const WebAddress& address, double seconds) noexcept override;
  std::optional<std::string> get(const WebAddress& address, const std::string& path,
                                 double seconds) noexcept override;

 private:
  class Connection;
  bool happens(double probability) { return std::uniform_real_distribution<double>()(random) < probability; }

  HaplyEmulator& service_;
  double now_ = 0.0;
  int connections_ = 0, opened_ = 0;
};

}  // namespace palpate::test
