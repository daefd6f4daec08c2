/// A link to a Polhemus tracker: Liberty, Patriot or Fastrak, on USB or a serial line.
///
/// It is made silent, told what to say and in which form, and then only listened to. One that falls silent is
/// set up anew; one that was pulled out is looked for, and all of its stations are out of sight meanwhile.
/// Poses are in the frame of the transmitter as the maker defines it: x forward, y right, z down.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <variant>

#include "common/device/atoms.h"
#include "common/device/driver/polhemus/polhemus_port.h"
#include "common/device/driver/polhemus/polhemus_record.h"
#include "common/device/driver_link.h"

namespace palpate {

// The stations of a tracker: what it reports of each becomes a pose that a hand can be led by.
//
// A report without a checksum may be damaged and still look like one. A hand does not leap: a pose farther
// from the last one than any hand goes in the time between waits until the next one confirms it, and so does
// the first one after a gap: what damage may do is bounded by kLeap + kMostSpeed kGap.

class TrackerStations {
 public:
  static constexpr double kSilence = 0.1;      ///< [s] unheard for so long a station is not seen
  static constexpr double kMostSpeed = 5.0;    ///< [m/s] of a hand
  static constexpr double kMostTurn = 50.0;    ///< [rad/s]
  static constexpr double kGap = 0.035;        ///< [s] the slowest tracker with all its sensors is faster
  static constexpr double kLeap = 0.03;        ///< [m] that times of arrival may be wrong by
  static constexpr double kTurnedLeap = 0.35;  ///< [rad] likewise

  struct Report {
    int station = 0;     ///< from 1
    bool good = true;    ///< else the tracker says that it does not see it well
    Vec3 position{0.0};  ///< [m]
    Quat orientation{1.0, 0.0, 0.0, 0.0};
    bool button = false;
  };

  TrackerStations() noexcept;

  /// False where it is implausible, or no station.
  bool take(double now, const Report& report) noexcept;
  /// Stations that have fallen silent are not seen any more. @return whether there are such.
  bool expire(double now) noexcept;
  void lose_all() noexcept;
  /// At a slow line one station is heard each `seconds` at best: gap and silence are longer then.
  void set_pace(double seconds) noexcept;

  [[nodiscard]] const PoseAtoms& poses() const noexcept { return poses_; }
  /// Bit i: the button of station i + 1 is down.
  [[nodiscard]] std::uint32_t buttons() const noexcept;

 private:
  double gap_ = kGap, silence_ = kSilence;  ///< [s]
  PoseAtoms poses_;
  struct Doubtful {
    PoseAtom pose;
    bool waits = false;
  };
  std::array<Doubtful, PoseAtoms::kStations> doubtful_{};
};

class PolhemusLink final : public DriverLink {
 public:
  static constexpr double kSilence = 0.5;   ///< [s] unheard for so long it is set up anew
  static constexpr double kPatience = 2.0;  ///< [s] that it may take to speak after it was set up
  static constexpr int kMostMisses = 5;     ///< transfers in a row that may fail

  PolhemusLink(std::unique_ptr<PolhemusPort> port, const PolhemusSettings& settings);
  /// Leaves it silent.
  ~PolhemusLink() override;

  bool round() noexcept override;
  [[nodiscard]] const DeviceAtoms& atoms() const noexcept override { return atoms_; }
  [[nodiscard]] const PoseAtoms* poses() const noexcept override { return &stations_.poses(); }
  [[nodiscard]] const LinkStatus& status() const noexcept override { return status_; }
  [[nodiscard]] std::string advice() const override;
  [[nodiscard]] const DeviceLimits& limits() const noexcept override { return limits_; }
  [[nodiscard]] std::string place() const override { return opened_.place; }

 private:
  enum class Stage : std::uint8_t { kSearch, kSilence, kSetUp, kRun };

  void search() noexcept;
  void begin_set_up() noexcept;
  void drain() noexcept;
  void set_up() noexcept;
  bool listen() noexcept;
  bool take(const PolhemusNews& news, double now) noexcept;
  bool close() noexcept;
  bool send(std::string_view command) noexcept;
  /// Whether the transfer shows that the tracker is gone, or of no use any more.
  bool is_lost(const TransferResult& result) noexcept;
  void publish(double now) noexcept;

  std::unique_ptr<PolhemusPort> port_;
  PolhemusSettings settings_;
  DeviceLimits limits_;  ///< it shows no force
  LinkStatus status_;
  DeviceAtoms atoms_;
  TrackerStations stations_;
  double pace_ = 0.0;  ///< [s] between two records of a station that its line allows
  PolhemusOpened opened_;
  std::variant<LibertyParser, FastrakParser> parser_;
  std::uint64_t dropped_before_ = 0;  ///< by the parser, when it was new

  Stage stage_ = Stage::kSearch;
  TransferStatus refused_ = TransferStatus::kOk;
  double heard_ = 0.0;  ///< [s] when a record came, or it was set up
  bool spoke_ = false;  ///< since it was set up
  bool lost_ = false;   ///< the last command could not be sent, nor will the next
  int drains_ = 0, misses_ = 0;
  int dumb_set_ups_ = 0;    ///< in a row that brought nothing
  bool no_sensor_ = false;  ///< it says so
  int poor_station_ = 0;    ///< that it does not see well; 0: none
  char poor_code_ = ' ';
};

}  // namespace palpate
