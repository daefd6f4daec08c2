// What comes over a network: the first byte chooses a VRPN server's stream or a message of Haply's service,
// the second how the stream is cut. Whoever sends it, nothing is taken that makes no sense, and the link to
// such a server pushes no harder than it may.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "common/device/driver/inverse3/inverse3_message.h"
#include "common/device/driver/vrpn/vrpn_link.h"
#include "tests/common/device/driver/round_with.h"

using namespace palpate;

namespace {

void require(bool holds) {
  if (!holds) __builtin_trap();
}

constexpr double kCap = 3.0;  // [N]

/// A server that says what the fuzzer says, in pieces, and whose client's forces are looked at.
class SayingPlace final : public StreamPlace {
 public:
  SayingPlace(std::span<const std::uint8_t> bytes, std::size_t piece) : bytes_(bytes), piece_(piece) {}

  StreamOpened open() override { return {TransferStatus::kOk, std::make_unique<Stream>(*this)}; }
  [[nodiscard]] std::string name() const override { return "fuzzer"; }
  [[nodiscard]] double now() const noexcept override { return now_; }
  void sleep(double seconds) noexcept override { now_ += std::max(0.0, seconds); }

 private:
  class Stream final : public ByteStream {
   public:
    explicit Stream(SayingPlace& place) : place_(place), left_(place.bytes_) {}
    TransferResult read(std::span<std::uint8_t> data, double seconds) noexcept override {
      place_.sleep(left_.empty() ? seconds : 0.001);
      if (left_.empty()) return {TransferStatus::kTimeout, 0};
      const std::size_t bytes = std::min({place_.piece_, left_.size(), data.size()});
      std::copy_n(left_.begin(), bytes, data.begin());
      left_ = left_.subspan(bytes);
      return {TransferStatus::kOk, bytes};
    }
    TransferResult write(std::span<const std::uint8_t> data, double /*seconds*/) noexcept override {
      // What was sent is whole, and its fields hold no more than the cap.
      VrpnMessage message;
      for (std::span<const std::uint8_t> sent = data;;) {
        const auto found = parser_.push(sent, message);
        require(found != VrpnParser::Found::kNonsense);
        if (found == VrpnParser::Found::kNothing) break;
        if (found == VrpnParser::Found::kMessage && message.type == 2) check(message.payload);
      }
      return {TransferStatus::kOk, data.size()};
    }

   private:
    static void check(std::span<const std::uint8_t> payload) {
      require(payload.size() == 64);
      double force = 0.0, stiffness = 0.0;
      const auto value = [&](std::size_t at) {
        std::uint32_t bits = 0;
        for (std::size_t i = 0; i < 4; ++i) bits = bits << 8U | payload[4 * at + i];
        return static_cast<double>(std::bit_cast<float>(bits));
      };
      for (std::size_t i = 3; i < 6; ++i) force += value(i) * value(i);
      for (std::size_t i = 6; i < 15; ++i) stiffness += value(i) * value(i);
      // The largest eigenvalue is no less than a third of this norm's square's root.
      require(std::sqrt(force) + std::sqrt(stiffness / 3.0) * value(15) <= 1.001 * kCap);
    }
    SayingPlace& place_;
    std::span<const std::uint8_t> left_;
    VrpnParser parser_;
  };

  std::span<const std::uint8_t> bytes_;
  std::size_t piece_;
  double now_ = 1.0;
};

void vrpn(std::span<const std::uint8_t> bytes, std::size_t piece) {
  VrpnLink link(std::make_unique<SayingPlace>(bytes, piece),
                vrpn_settings({{"at", "Tracker0@fuzzer"}, {"cap", "3"}}));
  constexpr int kRounds = 300;
  for (int n = 0; n < kRounds; ++n) {
    (void)test::round_with(link, n % 4 == 0 ? Vec3{0.0} : Vec3{10.0 * std::sin(n), -5.0, 1.0 * n});
    require(is_finite(link.atoms().position));
    for (const double value : link.atoms().valuators) require(std::abs(value) <= 1.0);
  }
}

void haply(std::span<const std::uint8_t> bytes) {
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  (void)haply_spelling(text);
  HaplyState state;
  if (!read_haply_state(text, "", state)) return;
  require(state.buttons < 16);
  if (state.position) require(is_finite(*state.position));
  if (state.device) require(HaplyId::from(state.device->view()).has_value());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 2) return 0;
  const std::span<const std::uint8_t> rest(data + 2, size - 2);
  if (data[0] % 2 == 0) {
    vrpn(rest, 1 + data[1]);
  } else {
    haply(rest);
  }
  return 0;
}
