#include "common/calibration/synthetic_arm.h"

#include <cmath>
#include <optional>
#include <random>

#include "common/base/index.h"
#include "common/calibration/arm_problem.h"

namespace palpate {
namespace {

constexpr double kPlacing = 0.3e-3;      // [m] an axis
constexpr double kGridStep = 0.127;      // 5 inches
constexpr double kNominalError = 45e-3;  // [m]: Ikits 2006, sec. 4.3.3, says 30 to 60 mm
const std::vector<double> kRest{0.0, 0.5, 0.3, 0.0, 0.0, 0.0};  // the middle of the joints' range [rad]
// Before they are scaled to that:
constexpr double kOffsetError = 3.2 * kDegree;  // of joints, standard deviation
constexpr double kAngleError = 0.7 * kDegree;   // of other angles
constexpr double kLengthError = 4e-3;           // [m]

/// Readings of the first three joints that bring the tip to `target`, the wrist's being given: Newton from
/// the middle of the arm's range.
std::optional<std::vector<double>> reaching(const DhhChain& arm, const Vec3& target,
                                            std::vector<double> readings) {
  constexpr int kRounds = 60;
  constexpr double kThere = 1e-12, kStep = 1e-6, kMostTurn = 0.3;
  for (int round = 0; round < kRounds; ++round) {
    const Vec3 left = target - arm.forward(readings).translation;
    if (glm::length(left) < kThere) {
      constexpr double kRange = 2.0;  // [rad] from the middle
      for (int j = 0; j < 3; ++j) {
        if (std::abs(readings[as_size(j)]) > kRange) return std::nullopt;
      }
      return readings;
    }
    Mat3 jacobian{0.0};
    for (int j = 0; j < 3; ++j) {
      std::vector<double> above = readings, below = readings;
      above[as_size(j)] += kStep;
      below[as_size(j)] -= kStep;
      jacobian[j] = (arm.forward(above).translation - arm.forward(below).translation) / (2.0 * kStep);
    }
    constexpr double kSingular = 1e-6;
    if (std::abs(glm::determinant(jacobian)) < kSingular) return std::nullopt;
    Vec3 turn = glm::inverse(jacobian) * left;
    const double size = glm::length(turn);
    if (size > kMostTurn) turn *= kMostTurn / size;
    for (int j = 0; j < 3; ++j) readings[as_size(j)] += turn[j];
  }
  return std::nullopt;
}

}  // namespace

SyntheticArm synthetic_arm(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  // Beyond two deviations a maker would have noticed.
  const auto drawn = [&] {
    double value = normal(random);
    while (std::abs(value) > 2.0) value = normal(random);
    return value;
  };
  SyntheticArm out{nominal_phantom_3(), nominal_phantom_3()};
  for (DhhRow& row : out.actual.rows) {
    for (std::size_t q = 0; q < kDhhQuantities; ++q) {
      if (!row.free[q]) continue;
      const auto quantity = static_cast<DhhQuantity>(q);
      const bool length = quantity == DhhQuantity::kD || quantity == DhhQuantity::kA;
      const bool offset = row.joint >= 0 && quantity == DhhQuantity::kGamma;
      row.values[q] += drawn() * (length ? kLengthError : offset ? kOffsetError : kAngleError);
    }
  }
  // The joints' offsets by one factor, until the nominal arm is wrong by as much as the reference's was.
  std::vector<std::vector<double>> poses(200, kRest);
  for (auto& readings : poses) {
    for (double& reading : readings) reading += 0.5 * normal(random);
  }
  constexpr int kRounds = 12;  // offsets make most of the error
  for (int round = 0; round < kRounds; ++round) {
    double mean = 0.0;
    for (const auto& readings : poses) {
      mean +=
          glm::distance(out.actual.forward(readings).translation, out.nominal.forward(readings).translation) /
          static_cast<double>(poses.size());
    }
    for (const auto& [row, quantity] : offset_parameters(out.nominal)) {
      const auto r = as_size(row), q = as_size(quantity);
      const double nominal = out.nominal.rows[r].values[q];
      double& actual = out.actual.rows[r].values[q];
      actual = nominal + (actual - nominal) * kNominalError / mean;
    }
  }
  return out;
}

std::vector<ArmMeasurement> synthetic_arm_measurements(const SyntheticArm& arm, bool second_grid,
                                                       std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> within(-1.0, 1.0);
  // Where the arm's tip is with all joints in the middle of their range, projected on to the first grid's
  // plane.
  const Vec3 rest = arm.nominal.forward(kRest).translation;
  const Rigid upright{rotation_by({85.0 * kDegree, 0.0, 0.0}), {rest.x, rest.y - 0.1, -0.2}};
  std::vector<ArmMeasurement> out;
  const auto measure = [&](const Vec3& point, int grid) {
    const Vec3 noise{normal(random), normal(random), normal(random)};
    const Vec3 target = (grid > 0 ? upright * point : point) + kPlacing * noise;
    constexpr int kWrists = 20;
    for (int attempt = 0; attempt < kWrists; ++attempt) {
      std::vector<double> readings = kRest;
      readings[3] = 1.2 * within(random);
      readings[4] = 1.0 * within(random);
      readings[5] = 2.5 * within(random);
      if (auto found = reaching(arm.actual, target, readings)) {
        out.push_back({point, std::move(*found), grid});
        return;
      }
    }
  };
  for (int y = 0; y < 5; ++y) {
    for (int x = 0; x < 8; ++x)
      measure({rest.x + (x - 3.5) * kGridStep, rest.y - 0.1 + (y - 2) * kGridStep, 0.0}, 0);
  }
  for (int z = 0; second_grid && z < 4; ++z) {
    for (int x = 0; x < 5; ++x) measure({(x - 2) * kGridStep, z * kGridStep, 0.0}, 1);
  }
  return out;
}

}  // namespace palpate
