/// A bus without hardware: devices are models in this process, time is what the test says or the system's,
/// and anything that a cable does can be made to happen.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "common/device/driver/transport/usb.h"

namespace palpate::test {

/// A device at the wire. Times are in seconds and never fall.
class FakeDevice {
 public:
  virtual ~FakeDevice() = default;

  [[nodiscard]] virtual UsbDevice description() const = 0;
  virtual void opened(double /*now*/) {}
  virtual void closed(double /*now*/) {}
  virtual TransferStatus control(double now, const UsbControl& setup, std::span<const std::uint8_t> data) = 0;
  /// A control transfer with data to the host; 0: it stalls.
  virtual std::size_t answer(double /*now*/, const UsbControl& /*setup*/, std::span<std::uint8_t> /*data*/) {
    return 0;
  }
  virtual void write(double now, std::uint8_t endpoint, std::span<const std::uint8_t> data) = 0;
  /// What it has to say by `now`, as one packet; nothing: 0.
  virtual std::size_t read(double now, std::uint8_t endpoint, std::span<std::uint8_t> data) = 0;
};

/// What goes wrong, each with a probability per transfer.
struct CableFaults {
  double lost_write = 0.0;    ///< it never arrives, and looks as if it did
  double short_write = 0.0;   ///< half of it arrives
  double lost_read = 0.0;     ///< a packet to the host vanishes
  double corrupt_read = 0.0;  ///< one bit of it is flipped
  double short_read = 0.0;    ///< half of a packet arrives
  double late_read = 0.0;     ///< it comes `lateness` later
  double stall = 0.0;         ///< the transfer is refused
  double timeout = 0.0;       ///< a write is not taken in time
  double lateness = 0.004;    ///< [s]
  std::uint64_t seed = 1;
};

class FakeUsb final : public UsbTransport {
 public:
  enum class Clock { kVirtual, kSystem };
  explicit FakeUsb(Clock clock = Clock::kVirtual) : clock_(clock) {}

  void plug(const std::string& path, std::shared_ptr<FakeDevice> device) {
    devices_[path] = std::move(device);
  }
  /// Every transfer ends with kGone from now on.
  void unplug(const std::string& path) { devices_.erase(path); }
  void refuse(TransferStatus status) { refused_ = status; }  ///< to open anything; kOk: no longer
  void set_faults(const CableFaults& faults) {
    faults_ = faults;
    random_.seed(faults.seed);
  }
  /// Unplugs what does the `count`-th transfer from now on.
  void unplug_at_transfer(std::uint64_t count) { unplug_after_ = count; }
  [[nodiscard]] std::uint64_t transfers() const { return transfers_; }
  [[nodiscard]] int open_connections() const { return open_; }
  void set_guardian(bool there) { has_guardian_ = there; }
  /// Endpoint and bytes that were left to be written after the program.
  [[nodiscard]] const std::pair<int, std::vector<std::uint8_t>>& last_word() const { return last_word_; }

  std::vector<UsbDevice> devices() override;
  UsbOpened open(const std::string& path, int interface) override;
  TransferStatus access(const std::string& path) override;
  [[nodiscard]] double now() const noexcept override;
  void sleep(double seconds) noexcept override;

 private:
  class Connection;

  [[nodiscard]] bool happens(double probability);
  void spoil(std::span<std::uint8_t> data);  ///< flips a bit where that happens
  /// The device, or null where it is gone; counts a transfer.
  FakeDevice* transfer(const std::string& path, const std::shared_ptr<FakeDevice>& opened);

  Clock clock_;
  double now_ = 0.0;
  std::map<std::string, std::shared_ptr<FakeDevice>> devices_;
  TransferStatus refused_ = TransferStatus::kOk;
  CableFaults faults_;
  std::mt19937_64 random_{1};
  std::uint64_t transfers_ = 0;
  std::uint64_t unplug_after_ = 0;
  int open_ = 0;
  bool has_guardian_ = true;
  std::pair<int, std::vector<std::uint8_t>> last_word_;
};

}  // namespace palpate::test
