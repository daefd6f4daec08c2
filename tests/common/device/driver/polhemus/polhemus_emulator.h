/// A Polhemus tracker in bytes: it takes the commands of its family, in the middle of a line too, and makes
/// its own records of sensors that move about. Beside it, the same on USB.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "common/kinematics/tracker_correction.h"
#include "common/math/quaternion.h"
#include "tests/common/device/driver/transport/fake_line.h"
#include "tests/common/device/driver/transport/fake_usb.h"

namespace palpate::test {

struct EmulatedPolhemus {
  bool fastrak = false;
  std::string tag = "LY";         ///< of a Liberty; PA, LU
  std::uint16_t detected = 0b11;  ///< bit i: a sensor at station i + 1
  double rate = 240.0;            ///< [Hz] of all stations of a Liberty, of one at a time of a Fastrak
};

class PolhemusEmulator final : public Speaker {
 public:
  explicit PolhemusEmulator(const EmulatedPolhemus& settings = {}) : settings_(settings) {}

  /// Where a sensor is, and how it is turned [m], at `time` [s]: half a metre before the transmitter, as
  /// hands go.
  [[nodiscard]] static Vec3 position(int station, double time);
  [[nodiscard]] static Quat orientation(int station, double time);

  /// What a tracker says near metal: 30 mm and 4 degrees off where hands go, by a smooth field of its own.
  [[nodiscard]] static TrackerPose distorted(const TrackerPose& actual);
  /// It stands near metal.
  void distort(bool on) { distorts_ = on; }

  void press(int station, bool down) { pressed_[static_cast<std::size_t>(station - 1)] = down; }
  /// What the tracker says of the signal of a station; ' ': it is good.
  void complain(int station, char error) { errors_[static_cast<std::size_t>(station - 1)] = error; }
  void unplug_sensor(int station) {
    settings_.detected &= static_cast<std::uint16_t>(~(1U << (station - 1)));
  }
  /// It hangs: says nothing, hears nothing, though it is still plugged in.
  void hang(bool on) { hangs_ = on; }
  /// All sensors stand still at the place of time 0.
  void freeze(bool on) { frozen_ = on; }
  /// Nothing that it hears changes what it does, as with a wrong rate of the line.
  void deafen(bool on) { deaf_ = on; }

  [[nodiscard]] bool continuous() const { return continuous_; }
  [[nodiscard]] const std::string& order() const { return order_; }
  [[nodiscard]] Vec3 zenith() const { return zenith_; }
  [[nodiscard]] int bad_commands() const { return bad_commands_; }
  [[nodiscard]] const EmulatedPolhemus& settings() const { return settings_; }

  void opened(double now) override { next_ = now; }
  void hear(double now, std::span<const std::uint8_t> bytes) override;
  void speak(double now, std::vector<std::uint8_t>& bytes) override;
  /// What it answers, and what it says by itself, apart.
  void speak(double now, std::vector<std::uint8_t>& answers, std::vector<std::uint8_t>& data);

 private:
  void obey(double now, const std::string& line);
  void obey_liberty(double now, const std::string& line);
  void obey_fastrak(const std::string& line);
  void say_records(double time, char command, std::vector<std::uint8_t>& out);
  void say_liberty(double time, char command, int station, std::vector<std::uint8_t>& out);
  void say_fastrak(double time, int station, std::vector<std::uint8_t>& out);
  [[nodiscard]] TrackerPose said_pose(double time, int station) const;

  EmulatedPolhemus settings_;
  bool binary_ = false, continuous_ = false, centimetres_ = false;
  std::string order_ = "2,4,1";
  Vec3 zenith_{1.0, 0.0, 0.0};
  std::array<bool, 16> pressed_{};
  std::array<char, 16> errors_ = [] {
    std::array<char, 16> none{};
    none.fill(' ');
    return none;
  }();
  std::string half_;  ///< of a line that is not ended
  std::vector<std::uint8_t> answers_;
  double next_ = 0.0;
  std::uint32_t frame_ = 0;
  int turn_ = 0;  ///< the station of a Fastrak that is next
  bool hangs_ = false, frozen_ = false, deaf_ = false, distorts_ = false;
  int bad_commands_ = 0;
};

/// A tracker on USB. Its bytes come in packets of any size up to what a transfer takes: several records in
/// one, or one in several.
class PolhemusOnUsb final : public FakeDevice {
 public:
  PolhemusOnUsb(UsbId id, std::shared_ptr<PolhemusEmulator> tracker)
      : id_(id), tracker_(std::move(tracker)) {}

  void split(bool on) { splits_ = on; }

  UsbDevice description() const override;
  void opened(double now) override;
  TransferStatus control(double, const UsbControl&, std::span<const std::uint8_t>) override {
    return TransferStatus::kStall;
  }
  void write(double now, std::uint8_t endpoint, std::span<const std::uint8_t> data) override;
  std::size_t read(double now, std::uint8_t endpoint, std::span<std::uint8_t> data) override;

 private:
  [[nodiscard]] bool fastrak() const { return tracker_->settings().fastrak; }

  UsbId id_;
  std::shared_ptr<PolhemusEmulator> tracker_;
  std::vector<std::uint8_t> answers_, data_;
  bool splits_ = true;
  std::mt19937 random_{11};
};

}  // namespace palpate::test
