/// A Falcon in a hand, at the wire: the FTDI bridge with its speeds, latency and status bytes, the loader,
/// the firmware's packets, homing, and an arm with mass, damping, friction and encoders.
///
/// Its kinematics are its own: the loop closure of a leg, g(theta) = |elbow - joint|^2 - L^2 = 0, solved by
/// bisection where the driver has a closed form, and differentiated implicitly. It codes packets by itself,
/// too.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <random>
#include <utility>
#include <vector>

#include "common/math/vec.h"
#include "tests/common/device/driver/transport/fake_usb.h"

namespace palpate::test {

struct EmulatedFalcon {
  double gain = 3500.0;   ///< counts per N m
  double mass = 0.6;      ///< [kg] arm and hand
  double damping = 3.0;   ///< [N s/m]
  double friction = 0.7;  ///< [N] on each axis
  double hand = 80.0;     ///< [N/m] of the spring to where the hand wants to be
  bool loaded = false;    ///< the firmware runs from the start
  bool homed = false;
  int failing_uploads = 0;  ///< so many have a wrong echo in them
  bool deaf_loader = false;
  bool raises_cts = true;
  Vec3 start{0.0, 0.0, 0.12};  ///< [m] where it rests at first
  std::uint64_t seed = 5;
};

class FalconEmulator final : public FakeDevice {
 public:
  static constexpr Vec3 kMiddle{0.0, 0.0, 0.125};

  explicit FalconEmulator(const EmulatedFalcon& settings);

  // The hand.

  /// Where it wants to be [m], in the frame of the arm.
  void set_target(const Vec3& target) { target_ = target; }
  void press(std::uint8_t buttons) { buttons_ = buttons; }
  /// Out and in, by itself, while an encoder has no zero.
  void home_by_itself(bool on) { home_by_itself_ = on; }
  /// Power off and on: firmware and zero are lost.
  void restart();
  void lose_zero();
  /// An encoder that shows other counts from now on.
  void slip(std::size_t leg, int counts) { slipped_[leg] += counts; }

  // What became of it.

  [[nodiscard]] const Vec3& position() const { return x_; }
  [[nodiscard]] const Vec3& velocity() const { return v_; }
  [[nodiscard]] const Vec3& motor_force() const { return motor_force_; }
  [[nodiscard]] std::array<int, 3> motors() const { return motors_; }
  [[nodiscard]] std::array<int, 3> counts() const;
  [[nodiscard]] bool homed() const { return homed_ == 7; }
  [[nodiscard]] bool running() const { return running_; }
  [[nodiscard]] const std::vector<std::uint8_t>& image() const { return image_; }
  [[nodiscard]] std::uint64_t commands() const { return commands_; }
  [[nodiscard]] double largest_force() const { return largest_force_; }  ///< [N] of the motors so far
  [[nodiscard]] int largest_motor() const { return largest_motor_; }     ///< any command so far
  [[nodiscard]] bool pushed_unhomed() const { return pushed_unhomed_; }  ///< a motor was on without a zero
  [[nodiscard]] unsigned lights() const { return lights_; }
  [[nodiscard]] std::uint64_t answers_waiting() const { return most_waiting_; }
  /// Control transfers as request and value, in order.
  [[nodiscard]] const std::vector<std::pair<int, int>>& controls() const { return controls_; }

  UsbDevice description() const override;
  TransferStatus control(double now, const UsbControl& setup, std::span<const std::uint8_t> data) override;
  void write(double now, std::uint8_t endpoint, std::span<const std::uint8_t> data) override;
  std::size_t read(double now, std::uint8_t endpoint, std::span<std::uint8_t> data) override;

 private:
  struct Byte {
    double time = 0.0;
    std::uint8_t value = 0;
  };
  struct Leg {
    double angle = 0.0;
    Vec3 rate{0.0};  ///< d angle / d position
  };

  void advance(double now);
  void move(double dt);
  [[nodiscard]] bool legs_at(const Vec3& x, std::array<Leg, 3>& legs) const;
  void take(double now, std::uint8_t byte);
  void take_loader(double now, std::uint8_t byte);
  void take_packet(double now, std::uint8_t byte);
  void say(double now, std::uint8_t byte);
  [[nodiscard]] double byte_time() const;

  EmulatedFalcon settings_;
  std::mt19937_64 random_;

  // The bridge.
  int divisor_ = 0x4138, latency_ = 16;
  bool dtr_ = false, rts_ = true, dtr_pulsed_ = false;
  double next_flush_ = 0.0;
  std::deque<Byte> to_device_, to_host_;
  std::vector<std::pair<int, int>> controls_;

  // Loader and firmware.
  bool running_ = false, greeted_ = false, uploading_ = false;
  std::vector<std::uint8_t> hello_, image_;
  double last_image_byte_ = 0.0;
  std::vector<std::uint8_t> packet_;
  std::uint64_t commands_ = 0;
  unsigned lights_ = 0;

  // The arm.
  double time_ = 0.0;
  Vec3 x_, v_{0.0}, target_{kMiddle}, motor_force_{0.0};
  std::array<Leg, 3> legs_{};
  std::array<int, 3> motors_{}, offset_{}, slipped_{};
  std::array<bool, 3> was_out_{};
  int homed_ = 0;
  bool homing_ = false, home_by_itself_ = true;
  double gesture_ = 0.0;
  std::uint8_t buttons_ = 0;
  double largest_force_ = 0.0;
  int largest_motor_ = 0;
  bool pushed_unhomed_ = false;
  std::uint64_t most_waiting_ = 0;
};

}  // namespace palpate::test
