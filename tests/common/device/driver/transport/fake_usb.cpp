#include "tests/common/device/driver/transport/fake_usb.h"

#include <algorithm>
#include <chrono>
#include <thread>

namespace palpate::test {
namespace {

constexpr double kTick = 1e-4;          // [s] between two looks whether a device has something to say
constexpr double kTransferTime = 2e-5;  // [s] that any transfer takes

}  // namespace

class FakeUsb::Connection final : public UsbConnection {
 public:
  Connection(FakeUsb& bus, std::string path, std::shared_ptr<FakeDevice> device)
      : bus_(bus), path_(std::move(path)), device_(std::move(device)) {
    ++bus_.open_;
    device_->opened(bus_.now());
  }
  ~Connection() override {
    --bus_.open_;
    device_->closed(bus_.now());
  }

  TransferResult control(const UsbControl& setup, std::span<const std::uint8_t> data,
                         double) noexcept override {
    if (bus_.transfer(path_, device_) == nullptr) return {TransferStatus::kGone, 0};
    if (bus_.happens(bus_.faults_.stall)) return {TransferStatus::kStall, 0};
    return {device_->control(bus_.now(), setup, data), data.size()};
  }

  TransferResult ask(const UsbControl& setup, std::span<std::uint8_t> data,
                     double seconds) noexcept override {
    if (bus_.transfer(path_, device_) == nullptr) return {TransferStatus::kGone, 0};
    if (bus_.happens(bus_.faults_.stall)) return {TransferStatus::kStall, 0};
    if (bus_.happens(bus_.faults_.lost_read)) {
      bus_.sleep(seconds);
      return {TransferStatus::kTimeout, 0};
    }
    const std::size_t bytes = device_->answer(bus_.now(), setup, data);
    if (bytes == 0) return {TransferStatus::kStall, 0};
    bus_.spoil(data.first(bytes));
    return {TransferStatus::kOk, bytes};
  }

  bool leave_last_word(const UsbEndpoint& endpoint, std::span<const std::uint8_t> word) override {
    bus_.last_word_ = {endpoint.address, {word.begin(), word.end()}};
    return bus_.has_guardian_;
  }

  TransferResult write(const UsbEndpoint& endpoint, std::span<const std::uint8_t> data,
                       double seconds) noexcept override {
    if (bus_.transfer(path_, device_) == nullptr) return {TransferStatus::kGone, 0};
    if (bus_.happens(bus_.faults_.stall)) return {TransferStatus::kStall, 0};
    if (bus_.happens(bus_.faults_.timeout)) {
      bus_.sleep(seconds);
      return {TransferStatus::kTimeout, 0};
    }
    if (bus_.happens(bus_.faults_.lost_write)) return {TransferStatus::kOk, data.size()};
    const bool cut = bus_.happens(bus_.faults_.short_write);
    const auto sent = data.first(cut ? data.size() / 2 : data.size());
    device_->write(bus_.now(), endpoint.address, sent);
    return {TransferStatus::kOk, sent.size()};
  }

  TransferResult read(const UsbEndpoint& endpoint, std::span<std::uint8_t> data,
                      double seconds) noexcept override {
    if (bus_.happens(bus_.faults_.stall)) return {TransferStatus::kStall, 0};
    if (bus_.happens(bus_.faults_.late_read)) bus_.sleep(bus_.faults_.lateness);
    const double until = bus_.now() + seconds;
    for (;;) {
      if (bus_.transfer(path_, device_) == nullptr) return {TransferStatus::kGone, 0};
      std::size_t bytes = device_->read(bus_.now(), endpoint.address, data);
      if (bytes > 0 && bus_.happens(bus_.faults_.lost_read)) bytes = 0;
      if (bytes > 0) {
        bus_.spoil(data.first(bytes));
        if (bus_.happens(bus_.faults_.short_read)) bytes /= 2;
        return {TransferStatus::kOk, bytes};
      }
      if (bus_.now() >= until) return {TransferStatus::kTimeout, 0};
      bus_.sleep(std::min(kTick, std::max(until - bus_.now(), 1e-6)));
    }
  }

 private:
  FakeUsb& bus_;
  std::string path_;
  std::shared_ptr<FakeDevice> device_;
};

bool FakeUsb::happens(double probability) {
  return probability > 0.0 && std::uniform_real_distribution<double>()(random_) < probability;
}

void FakeUsb::spoil(std::span<std::uint8_t> data) {
  if (!happens(faults_.corrupt_read)) return;
  data[random_() % data.size()] ^= static_cast<std::uint8_t>(1U << (random_() % 8));
}

FakeDevice* FakeUsb::transfer(const std::string& path, const std::shared_ptr<FakeDevice>& opened) {
  if (clock_ == Clock::kVirtual) now_ += kTransferTime;
  ++transfers_;
  if (unplug_after_ > 0 && --unplug_after_ == 0) devices_.erase(path);
  const auto found = devices_.find(path);
  return found != devices_.end() && found->second == opened ? opened.get() : nullptr;
}

std::vector<UsbDevice> FakeUsb::devices() {
  std::vector<UsbDevice> all;
  for (const auto& [path, device] : devices_) {
    all.push_back(device->description());
    all.back().path = path;
  }
  return all;
}

UsbOpened FakeUsb::open(const std::string& path, int /*interface*/) {
  const auto found = devices_.find(path);
  if (found == devices_.end()) return {TransferStatus::kGone, nullptr};
  if (refused_ != TransferStatus::kOk) return {refused_, nullptr};
  return {TransferStatus::kOk, std::make_unique<Connection>(*this, path, found->second)};
}

TransferStatus FakeUsb::access(const std::string& path) {
  return devices_.count(path) > 0 ? refused_ : TransferStatus::kGone;
}

double FakeUsb::now() const noexcept {
  if (clock_ == Clock::kVirtual) return now_;
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

void FakeUsb::sleep(double seconds) noexcept {
  if (clock_ == Clock::kVirtual) {
    now_ += seconds;
  } else {
    std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
  }
}

}  // namespace palpate::test
