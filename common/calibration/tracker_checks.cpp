#include "common/calibration/tracker_checks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "common/base/error.h"
#include "common/base/quantile.h"
#include "common/base/text.h"

namespace palpate {
namespace {

/// Another way to read a table, by which a slip shows.
struct Slip {
  const char* what;    ///< "the reported positions look like millimetres"
  const char* remedy;  ///< "write metres"
  bool turns;          ///< it shows in orientations, else in positions
  TrackerMeasurement (*mended)(TrackerMeasurement row);
};

/// Read as w, x, y, z though written as x, y, z, w.
Quat moved_first(const Quat& q) { return {q.z, q.w, q.x, q.y}; }

constexpr std::array kSlips{Slip{"the reported positions look like millimetres", "write metres", false,
                                 [](TrackerMeasurement row) {
                                   row.reported.position *= 1e-3;
                                   return row;
                                 }},
                            Slip{"the actual positions look like millimetres", "write metres", false,
                                 [](TrackerMeasurement row) {
                                   row.actual.position *= 1e-3;
                                   return row;
                                 }},
                            Slip{"all positions look like millimetres", "write metres", false,
                                 [](TrackerMeasurement row) {
                                   row.reported.position *= 1e-3;
                                   row.actual.position *= 1e-3;
                                   return row;
                                 }},
                            Slip{"the reported positions look like centimetres", "write metres", false,
                                 [](TrackerMeasurement row) {
                                   row.reported.position *= 1e-2;
                                   return row;
                                 }},
                            Slip{"the reported positions look like inches", "write metres", false,
                                 [](TrackerMeasurement row) {
                                   row.reported.position *= 0.0254;
                                   return row;
                                 }},
                            Slip{"the reported quaternions look like x, y, z, w", "write w, x, y, z", true,
                                 [](TrackerMeasurement row) {
                                   row.reported.orientation = moved_first(row.reported.orientation);
                                   return row;
                                 }},
                            Slip{"the actual quaternions look like x, y, z, w", "write w, x, y, z", true,
                                 [](TrackerMeasurement row) {
                                   row.actual.orientation = moved_first(row.actual.orientation);
                                   return row;
                                 }},
                            Slip{"one side's quaternions look like conjugates of the other's",
                                 "give both as the turn from the sensor's axes to the transmitter's", true,
                                 [](TrackerMeasurement row) {
                                   row.reported.orientation = glm::conjugate(row.reported.orientation);
                                   return row;
                                 }}};

/// Half of the measurements are no worse than that [m], or [rad].
double median_error(const std::vector<TrackerMeasurement>& rows, const Slip* slip, bool turns) {
  std::vector<double> errors;
  for (const TrackerMeasurement& row : rows) {
    const Left left = left_by({}, slip != nullptr ? slip->mended(row) : row);
    errors.push_back(turns ? left.orientation : left.position);
  }
  return median(std::move(errors));
}

}  // namespace

Left left_by(const TrackerCorrection& correction, const TrackerMeasurement& row) {
  const TrackerPose pose = correction.corrected(row.reported);
  return {glm::distance(pose.position, row.actual.position),
          angle_of(row.actual.orientation * glm::conjugate(pose.orientation))};
}

void refuse_slips(const std::vector<TrackerMeasurement>& rows, const std::string& source) {
  constexpr double kMetal = 0.5, kMetalTurn = 30.0 * kDegree, kBetter = 0.25,
                   kRoom = 20.0;  // [m], [rad], 1, [m]
  if (rows.empty()) return;
  // A slip of both poses makes errors smaller by itself: it is seen by the size of the room.
  std::vector<double> lengths;
  for (const TrackerMeasurement& row : rows) lengths.push_back(glm::length(row.actual.position));
  const double usual = median(std::move(lengths));
  for (const bool turns : {false, true}) {
    const double before = median_error(rows, nullptr, turns);
    const bool large = before > (turns ? kMetalTurn : kMetal) || (!turns && usual > kRoom);
    if (!std::isfinite(before) || !large) continue;
    const Slip* best = nullptr;
    double least = kBetter * before;
    for (const Slip& slip : kSlips) {
      if (slip.turns != turns) continue;
      const double then = median_error(rows, &slip, turns);
      if (then < least) {
        least = then;
        best = &slip;
      }
    }
    if (best == nullptr) continue;
    const auto text = [turns](double error) {
      return turns ? short_number(std::round(10.0 * error / kDegree) / 10.0) + " degrees"
                   : short_number(std::round(1e6 * error) / 1e3) + " mm";
    };
    throw input_error({.file = source,
                       .place = "",
                       .found = std::string(best->what) + ": so read, half of the errors are below " +
                                text(least) + ", not " + text(before),
                       .expected = "metres, and quaternions w, x, y, z of the same turns",
                       .remedy = best->remedy});
  }
}

void require_betterment(const std::vector<Left>& before, const std::vector<Left>& after,
                        const std::string& source) {
  constexpr double kNoise = 2e-3, kTurnNoise = 0.5 * kDegree,
                   kLess = 0.95;  // [m], [rad] below these there is nothing to correct
  if (before.empty() || after.empty()) return;
  // In half of the cases: gross errors stay, and say nothing of the others.
  const auto half = [](const std::vector<Left>& all, double Left::*which) {
    std::vector<double> values;
    for (const Left& e : all) values.push_back(e.*which);
    return median(std::move(values));
  };
  const double was = half(before, &Left::position), is = half(after, &Left::position);
  if (was <= kNoise || is < kLess * was) return;
  // Places that are noisy alone, and turns that were corrected.
  constexpr double kNoisy = 0.01;  // [m]
  const double turned = half(before, &Left::orientation);
  if (was < kNoisy && turned > kTurnNoise && half(after, &Left::orientation) < kLess * turned) return;
  throw work_error(source + ": the correction leaves " + short_number(std::round(1e4 * is) / 10.0) +
                   " mm of " + short_number(std::round(1e4 * was) / 10.0) +
                   " mm on measurements that it has not seen: these errors do not depend on the place; check "
                   "which reported pose belongs to which actual one");
}

}  // namespace palpate
