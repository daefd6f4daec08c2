#include "tests/common/device/driver/transport/fake_place.h"

#include <algorithm>
#include <vector>

namespace palpate::test {
namespace {

constexpr double kStep = 0.0005;  // [s]
constexpr double kOneWay = 2e-4;  // [s]

}  // namespace

class FakePlace::Stream final : public ByteStream {
 public:
  explicit Stream(FakePlace& place) : place_(place) {
    ++place_.connections_;
    ++place_.opened_;
    place_.server_.connect(place_.now_);
  }
  ~Stream() override {
    --place_.connections_;
    place_.server_.leave(place_.now_);
  }

  TransferResult read(std::span<std::uint8_t> data, double seconds) noexcept override {
    const double until = place_.now_ + seconds;
    if (place_.happens(place_.faults.reset)) ended_ = true;
    for (;;) {
      if (!place_.listens || ended_) return {TransferStatus::kGone, 0};
      listen();
      if (!arrived_.empty() && !place_.stalled) break;
      if (place_.now_ >= until) return {TransferStatus::kTimeout, 0};
      place_.now_ = std::min(until, place_.now_ + kStep);
    }
    std::size_t most = data.size();
    if (place_.happens(place_.faults.split)) most = std::min<std::size_t>(most, 1 + place_.random() % 40);
    const std::size_t bytes = std::min(most, arrived_.size());
    std::copy_n(arrived_.begin(), bytes, data.begin());
    arrived_.erase(arrived_.begin(), arrived_.begin() + static_cast<std::ptrdiff_t>(bytes));
    if (place_.happens(place_.faults.corrupt))
      data[place_.random() % bytes] = static_cast<std::uint8_t>(place_.random());
    return {TransferStatus::kOk, bytes};
  }

  TransferResult write(std::span<const std::uint8_t> data, double seconds) noexcept override {
    if (!place_.listens || ended_) return {TransferStatus::kGone, 0};
    if (place_.stalled || place_.happens(place_.faults.full)) {
      place_.sleep(seconds);
      return {TransferStatus::kTimeout, 0};
    }
    place_.server_.take(place_.now_ + kOneWay, {data.begin(), data.end()});
    return {TransferStatus::kOk, data.size()};
  }

 private:
  /// What the server said by now arrives in its order, each part when its time has come.
  void listen() {
    VrpnEmulator::Bytes said;
    place_.server_.advance(place_.now_, said);
    if (!said.empty()) {
      const double delay = place_.happens(place_.faults.late) ? place_.faults.lateness : kOneWay;
      const double at = std::max(place_.now_ + delay, under_way_.empty() ? 0.0 : under_way_.back().first);
      under_way_.emplace_back(at, std::move(said));
    }
    while (!under_way_.empty() && under_way_.front().first <= place_.now_) {
      const auto& bytes = under_way_.front().second;
      arrived_.insert(arrived_.end(), bytes.begin(), bytes.end());
      under_way_.pop_front();
    }
  }

  FakePlace& place_;
  std::deque<std::pair<double, VrpnEmulator::Bytes>> under_way_;
  std::deque<std::uint8_t> arrived_;
  bool ended_ = false;
};

StreamOpened FakePlace::open() {
  sleep(0.001);
  if (!listens) return {TransferStatus::kGone, nullptr};
  return {TransferStatus::kOk, std::make_unique<Stream>(*this)};
}

void FakePlace::sleep(double seconds) noexcept {
  if (seconds > 0.0) now_ += seconds;
}

}  // namespace palpate::test
