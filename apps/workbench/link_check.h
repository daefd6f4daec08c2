/// How well a link to a device does: what it went through, its rate, how evenly, and how long a round takes.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "common/base/progress.h"
#include "common/device/driver_link.h"
#include "common/servo/time_histogram.h"

namespace palpate {

struct LinkCheck {
  struct Step {
    double time = 0.0;  ///< [s] since the start
    LinkPhase phase = LinkPhase::kAbsent;
  };
  std::vector<Step> steps;  ///< phases in order, each when it began
  bool ready = false;       ///< at the end
  double measured = 0.0;    ///< [s] of being ready
  TimeHistogram intervals;  ///< between two samples
  TimeHistogram rounds;     ///< that brought one: command, answer, position
  LinkStatus status;
  std::string advice;
  std::string place;
  bool has_arm = false;  ///< it is an arm: its rate and evenness are
  bool tracks = false;   ///< it is a tracker, whose pictures lag behind a low rate

  [[nodiscard]] double rate() const noexcept {
    return measured > 0.0 ? static_cast<double>(intervals.count()) / measured : 0.0;
  }
};

/// Works the link without force until it has been ready for `seconds`, or has not become so within
/// `patience` [s].
/// @throws Cancelled.
[[nodiscard]] LinkCheck check_link(DriverLink& link, double seconds, double patience, Progress& progress);

/// How long after its sample each force would be told to a device that is ready, by a servo of 1 kHz that asks for
/// none, for `seconds`. @pre link is not null. @throws Cancelled.
[[nodiscard]] TimeHistogram force_delays(std::shared_ptr<DriverLink> link, double seconds,
                                         Progress& progress);

/// What to do about it, a sentence a line, for people; empty where all is well.
[[nodiscard]] std::vector<std::string> advice_on(const LinkCheck& check);

/// The udev rule that lets whoever sits at the machine use a device of this id, "0403:cb48".
[[nodiscard]] std::string udev_rule(const std::string& id);

}  // namespace palpate
