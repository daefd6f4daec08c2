/// Serial arms in mixed Denavit-Hartenberg-Hayati form.
///
/// Row j takes frame j to frame j-1 by
///   T_j = Rz(theta_j) Tz(d_j) Tx(a_j) Rx(alpha_j) Ry(beta_j),   theta_j = psi + gamma_j                  (1)
/// where psi is the reading of the row's joint (0 where it has none) and gamma_j its offset. beta_j is
/// Hayati's parameter: between nearly parallel axes it takes the place of d_j, which jumps there (Ikits 2006,
/// table 4.2, after Hollerbach and Wampler 1996). Metres, radians.
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "common/math/quaternion.h"

namespace palpate {

/// The five numbers of a row, in the order of table 4.2.
enum class DhhQuantity : int { kD = 0, kA, kAlpha, kBeta, kGamma };
inline constexpr int kDhhQuantities = 5;

struct DhhRow {
  std::array<double, kDhhQuantities> values{};  ///< d, a [m], alpha, beta, gamma [rad]
  std::array<bool, kDhhQuantities> free{};      ///< what a full calibration estimates
  int joint = -1;                               ///< index of the reading that turns this row; -1: none
};

struct DhhChain {
  std::vector<DhhRow> rows;
  int joint_count = 0;

  /// The last frame in the first one's coordinates. @pre readings.size() == joint_count. @rt Safe.
  [[nodiscard]] Rigid forward(std::span<const double> readings) const noexcept;
};

/// "d0", "alpha3", "gamma5"
[[nodiscard]] std::string dhh_name(int row, DhhQuantity quantity);

/// The nominal PHANToM 3.0L of Ikits 2006, table 4.2, with its free and fixed parameters, a base frame on the
/// grid and a probe of 120 mm set 25 mm off the last axis (the table leaves both to the set-up).
[[nodiscard]] DhhChain nominal_phantom_3();

}  // namespace palpate
