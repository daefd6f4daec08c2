/// What is told of the servo, in the window and at the end of a run.
#pragma once

#include <string>
#include <vector>

#include "common/servo/servo_loop.h"

namespace palpate {

struct ServoRow {
  std::string name;
  std::string value;
};

/// Rate and what the system granted, jitter, overruns and cost of an update; energy and damping of the
/// passivity controller where that is in use, faults and stalls where there were any. Nothing before the
/// first tick.
[[nodiscard]] std::vector<ServoRow> servo_rows(const ServoState& state);

}  // namespace palpate
