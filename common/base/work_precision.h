/// Error beside time: one row of a work-precision diagram, and one of a stability table.
#pragma once

#include <string>
#include <utility>

namespace palpate {

/// What one method with one setting achieved on one subject.
struct WorkPrecision {
  std::string subject;     ///< what was computed ("carotid, 400 seeds")
  std::string method;      ///< "dp54"
  std::string parameter;   ///< "tolerance=1e-06"
  double error = 0.0;      ///< in the unit that error_kind names
  std::string error_kind;  ///< "max distance / diagonal"
  double seconds = 0.0;
};

/// One extreme case, what was measured and what was promised.
struct StabilityRow {
  std::string name;  ///< `case` in report.json
  double measured = 0.0;
  double limit = 0.0;
  bool holds = false;
};

/// A row with what it shows.
struct StabilityCase {
  StabilityRow row;
  std::string unit;     ///< of measured and limit: "of the diagonal", "points"
  std::string meaning;  ///< what was done
};

/// One that holds where `measured` is no more than `limit`.
[[nodiscard]] inline StabilityCase make_case(std::string name, double measured, double limit,
                                             std::string unit, std::string meaning) {
  return {{std::move(name), measured, limit, measured <= limit}, std::move(unit), std::move(meaning)};
}

}  // namespace palpate
