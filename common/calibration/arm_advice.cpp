#include "common/calibration/arm_advice.h"

#include <algorithm>
#include <cmath>

#include "common/base/text.h"
#include "common/calibration/identifiability.h"
#include "common/math/counter_random.h"
#include "common/math/symmetric3.h"

namespace palpate {
namespace {

constexpr std::size_t kPoses = 20;     // of a further grid, as in the reference
constexpr std::size_t kTries = 40000;  // random poses that are looked through for them
constexpr double kSlab = 0.01;         // [m]: this near to a plane counts as on it
constexpr double kReach = 0.5;         // [m] from the middle of what was measured
constexpr double kBeside = 0.25;       // [m] to a parallel grid

struct Plane {
  Vec3 origin{0.0}, normal{0.0};
  std::string words;
};

std::string place_text(const Vec3& x) {
  const auto two = [](double v) {
    return short_number(std::round(100.0 * v) / 100.0 + 0.0);
  };  // + 0: no "-0"
  return "(" + two(x.x) + ", " + two(x.y) + ", " + two(x.z) + ")";
}

Rigid frame_of(const Plane& plane) {
  // The turn that takes z to the normal; any one serves, as the frame is unknown in the fit.
  const Vec3 z{0.0, 0.0, 1.0};
  const double along = glm::dot(z, plane.normal);
  constexpr double kOpposite = -1.0 + 1e-9;
  if (along < kOpposite) return {Quat{0.0, 1.0, 0.0, 0.0}, plane.origin};
  const Vec3 axis = glm::cross(z, plane.normal);
  return {glm::normalize(Quat{1.0 + along, axis.x, axis.y, axis.z}), plane.origin};
}

/// Readings drawn from the ranges that were seen, somewhat widened.
std::vector<std::vector<double>> reachable(const std::vector<ArmMeasurement>& rows) {
  constexpr double kWider = 0.2;
  const std::size_t joints = rows[0].readings.size();
  std::vector<double> lower(joints, HUGE_VAL), upper(joints, -HUGE_VAL);
  for (const ArmMeasurement& row : rows) {
    for (std::size_t j = 0; j < joints; ++j) {
      lower[j] = std::min(lower[j], row.readings[j]);
      upper[j] = std::max(upper[j], row.readings[j]);
    }
  }
  std::vector<std::vector<double>> out(kTries, std::vector<double>(joints));
  std::uint64_t counter = 0;
  for (auto& readings : out) {
    for (std::size_t j = 0; j < joints; ++j) {
      const double more = kWider * (upper[j] - lower[j]);
      readings[j] = lower[j] - more + uniform_at(counter++) * (upper[j] - lower[j] + 2.0 * more);
    }
  }
  return out;
}

}  // namespace

std::vector<std::string> where_to_measure_next(const std::vector<ArmMeasurement>& rows,
                                               const ArmEstimate& estimate, const std::vector<DhhPlace>& free,
                                               double now) {
  Vec3 middle{0.0};
  std::vector<Vec3> tips;
  for (const ArmMeasurement& row : rows) {
    tips.push_back(estimate.chain.forward(row.readings).translation);
    middle += tips.back() / static_cast<double>(rows.size());
  }
  Mat3 spread{0.0};
  for (const Vec3& tip : tips) spread += glm::outerProduct(tip - middle, tip - middle);
  const SymmetricEigen axes = symmetric_eigen(spread);
  const Vec3 normal = axes.vectors[2];
  std::vector<Plane> planes{{middle + kBeside * normal, normal, "parallel to the first one"},
                            {middle - kBeside * normal, normal, "parallel to the first one"}};
  for (const int across : {0, 1})
    planes.push_back({middle, axes.vectors[across], "nearly perpendicular to the first one"});

  const auto candidates = reachable(rows);
  std::vector<Vec3> candidate_tips;
  candidate_tips.reserve(candidates.size());
  for (const auto& readings : candidates)
    candidate_tips.push_back(estimate.chain.forward(readings).translation);
  std::vector<std::pair<double, std::string>> ranked;
  for (const Plane& plane : planes) {
    const Rigid frame = frame_of(plane);
    const int grid = static_cast<int>(estimate.grids.size());
    std::vector<ArmMeasurement> all = rows;
    for (std::size_t c = 0; c < candidates.size() && all.size() < rows.size() + kPoses; ++c) {
      const Vec3 from = candidate_tips[c] - plane.origin;
      if (std::abs(glm::dot(from, plane.normal)) > kSlab || glm::length(from) > kReach) continue;
      all.push_back({frame.inverse() * candidate_tips[c], candidates[c], grid});
    }
    if (all.size() < rows.size() + kPoses) continue;  // the arm hardly gets there
    std::vector<Rigid> grids = estimate.grids;
    grids.push_back(frame);
    const double then = analyze(linearize(arm_problem(all, estimate.chain, grids, free))).condition_number;
    if (!(then < now)) continue;
    ranked.emplace_back(
        then, "measure " + std::to_string(kPoses) + " points of a further grid " + plane.words +
                  ", through " + place_text(plane.origin) + " m across " + place_text(plane.normal) +
                  ", the wrist turned at random: the condition number would fall from " +
                  short_number(std::round(now)) + " to about " + short_number(std::round(then)));
  }
  std::sort(ranked.begin(), ranked.end());
  std::vector<std::string> out;
  out.reserve(ranked.size());
  for (auto& [then, words] : ranked) out.push_back(std::move(words));
  return out;
}

}  // namespace palpate
