/// The stations of a tracker: what it reports of each becomes a pose that a hand can be led by.
///
/// A report without a checksum may be damaged and still look like one. A hand does not leap: a pose farther
/// from the last one than any hand goes in the time between waits until the next one confirms it, and so does
/// the first one after a gap: what damage may do is bounded by kLeap + kMostSpeed kGap.
#pragma once

#include <array>
#include <cstdint>

#include "common/device/atoms.h"

namespace palpate {

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

  [[nodiscard]] const PoseAtoms& poses() const noexcept { return poses_; }
  /// Bit i: the button of station i + 1 is down.
  [[nodiscard]] std::uint32_t buttons() const noexcept;

 private:
  PoseAtoms poses_;
  struct Doubtful {
    PoseAtom pose;
    bool waits = false;
  };
  std::array<Doubtful, PoseAtoms::kStations> doubtful_{};
};

}  // namespace palpate
