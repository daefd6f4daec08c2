/// A VRPN server with one arm, its buttons and channels, beside another device; its numbers are not the
/// client's, and it packs and unpacks by itself. Its own loop shows the force field that it was sent, a
/// thousand times a second.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tests/common/device/driver/arm_in_hand.h"

namespace palpate::test {

class VrpnEmulator {
 public:
  using Bytes = std::vector<std::uint8_t>;

  // What it is, and what goes wrong.
  std::string cookie = "vrpn: ver. 07.35";
  std::string device = "Phantom0";
  bool names_device = true;
  double rate = 500.0;       ///< [Hz] of poses; 0: none
  double analog_rate = 0.0;  ///< [Hz] of channels
  std::vector<double> channels;
  bool exact_stamps = false;  ///< else whole seconds
  double clock_ahead = 0.0;   ///< [s] of its clock before ours
  int sensor = 0;             ///< of the arm; another sensor is sent, too
  bool answers = true;        ///< pings
  bool silent = false;        ///< it says nothing at all
  bool nonsense = false;      ///< poses are no numbers
  ArmInHand arm;

  // What became of it.
  double largest_field = 0.0;  ///< [N] anywhere in a field that it was sent
  double stiffest = 0.0;       ///< [N/m] of one
  bool active_field = false;   ///< a field was sent that is not passive
  std::uint64_t fields = 0, pings = 0;
  Bytes strange;  ///< what it could not understand

  /// A client has come, or goes: with it goes the force.
  void connect(double now);
  void leave(double now);
  [[nodiscard]] bool connected() const { return connected_; }
  void take(double now, const Bytes& bytes);
  /// Lives on, and appends what it says to `out`.
  void advance(double now, Bytes& out);
  void press(unsigned button, bool down);
  /// Says a message of any kind: for what is damaged on purpose.
  void say(std::int32_t sender, std::int32_t type, const Bytes& payload) { put(sender, type, payload); }
  void say_raw(const Bytes& bytes) { said_.insert(said_.end(), bytes.begin(), bytes.end()); }
  static constexpr std::int32_t kSender = 17, kOther = 3, kPosQuat = 900, kChange = 12, kAnalog = 0,
                                kPong = 41, kError = 5;

 private:
  struct Field {
    Vec3 origin{0.0}, force{0.0};
    double jacobian[3][3] = {};
    double radius = 0.0;
  };

  void live(double now);
  void put(std::int32_t sender, std::int32_t type, const Bytes& payload);
  void describe(std::int32_t kind, std::int32_t number, const std::string& name);
  void take_message(std::int32_t sender, std::int32_t type, const Bytes& payload);
  [[nodiscard]] Vec3 force_at(const Vec3& p) const;
  void pose(std::int32_t sensor, const Vec3& p);

  bool connected_ = false, greeted_ = false;
  double time_ = 0.0, posed_ = 0.0, sent_channels_ = 0.0;
  Bytes said_, heard_;
  std::vector<std::string> senders_, types_;
  Field field_;
};

}  // namespace palpate::test
