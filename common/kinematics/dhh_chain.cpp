#include "common/kinematics/dhh_chain.h"

#include "common/base/index.h"

namespace palpate {
namespace {

/// Equation (1) for one row.
Rigid row_transform(const DhhRow& row, double reading) noexcept {
  const auto& [d, a, alpha, beta, gamma] = row.values;
  const Quat turn = rotation_by({0.0, 0.0, reading + gamma});
  // d and a act before alpha and beta, so they are turned by theta alone.
  const Vec3 shift = turn * Vec3{a, 0.0, d};
  return {turn * rotation_by({alpha, 0.0, 0.0}) * rotation_by({0.0, beta, 0.0}), shift};
}

}  // namespace

Rigid DhhChain::forward(std::span<const double> readings) const noexcept {
  Rigid pose;
  for (const DhhRow& row : rows) {
    const double reading = row.joint < 0 ? 0.0 : readings[as_size(row.joint)];
    pose = pose * row_transform(row, reading);
  }
  return pose;
}

std::string dhh_name(int row, DhhQuantity quantity) {
  constexpr std::array<const char*, kDhhQuantities> kNames{"d", "a", "alpha", "beta", "gamma"};
  return kNames[as_size(quantity)] + std::to_string(row);
}

DhhChain nominal_phantom_3() {
  constexpr double kLink = 0.4572;  // 18 inches
  constexpr double kQuarter = 90.0 * kDegree;
  const auto row = [](std::array<double, kDhhQuantities> values, std::array<bool, kDhhQuantities> free,
                      int joint) { return DhhRow{.values = values, .free = free, .joint = joint}; };
  DhhChain arm;
  arm.joint_count = 6;
  arm.rows = {
      // d, a, alpha, beta, gamma. The base on the grid is this project's: table 4.2 gives symbols there.
      row({-0.07, 0.40, 70.0 * kDegree, 0.0, 100.0 * kDegree}, {true, true, true, false, true}, -1),
      row({0.25, 0.0, -kQuarter, 0.0, 0.0}, {true, true, true, false, true}, 0),
      row({0.0, kLink, 0.0, 0.0, 0.0}, {false, true, true, true, true}, 1),
      row({0.0, 0.0, -kQuarter, 0.0, 0.0}, {true, true, true, false, true}, 2),
      row({-kLink, 0.0, kQuarter, 0.0, 0.0}, {true, true, true, false, true}, 3),
      row({0.0, 0.0, -kQuarter, 0.0, kQuarter}, {true, true, true, false, true}, 4),
      row({0.0, 0.0, 2.0 * kQuarter, 0.0, kQuarter}, {false, false, false, false, false}, 5),
      row({0.12, 0.025, 0.0, 0.0, 0.0}, {true, true, false, false, true}, -1),
  };
  return arm;
}

}  // namespace palpate
