/// A link to a Polhemus tracker: Liberty, Patriot or Fastrak, on USB or a serial line.
///
/// It is made silent, told what to say and in which form, and then only listened to. One that falls silent is
/// set up anew; one that was pulled out is looked for, and all of its stations are out of sight meanwhile.
/// Poses are in the frame of the transmitter as the maker defines it: x forward, y right, z down.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <variant>

#include "common/device/driver/polhemus/polhemus_options.h"
#include "common/device/driver/polhemus/polhemus_port.h"
#include "common/device/driver/polhemus/polhemus_record.h"
#include "common/device/driver/polhemus/tracker_stations.h"
#include "common/device/driver_link.h"

namespace palpate {

class PolhemusLink final : public DriverLink {
 public:
  static constexpr double kSilence = 0.5;   ///< [s] unheard for so long it is set up anew
  static constexpr double kPatience = 2.0;  ///< [s] that it may take to speak after it was set up
  static constexpr int kMostMisses = 5;     ///< transfers in a row that may fail

  PolhemusLink(std::unique_ptr<PolhemusPort> port, const PolhemusSettings& settings);
  /// Leaves it silent.
  ~PolhemusLink() override;

  bool round(const Vec3& force) noexcept override;
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
