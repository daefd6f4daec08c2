/// The least-squares problem of an arm's calibration (Ikits 2006, eq. 4.15), shared by its fit and its
/// advice.
#pragma once

#include <utility>
#include <vector>

#include "common/calibration/least_squares.h"
#include "common/calibration/measurements.h"
#include "common/kinematics/dhh_chain.h"

namespace palpate {

/// A number of the chain that is estimated.
using DhhPlace = std::pair<int, DhhQuantity>;

[[nodiscard]] std::vector<DhhPlace> full_parameters(const DhhChain& chain);
/// The offsets gamma of those joints whose offset is free.
[[nodiscard]] std::vector<DhhPlace> offset_parameters(const DhhChain& chain);

/// Block 0: the numbers of the chain; two blocks more (position, rotation) for every grid but the first.
/// Residual: where the grid says the tip was less where the arm says it was, in the first grid's frame [m].
/// @param grids where each grid is in the first one's frame; grids[0] is the identity.
[[nodiscard]] LeastSquaresProblem arm_problem(const std::vector<ArmMeasurement>& rows, const DhhChain& chain,
                                              const std::vector<Rigid>& grids,
                                              const std::vector<DhhPlace>& free);

/// What the blocks of a problem say.
struct ArmEstimate {
  DhhChain chain;
  std::vector<Rigid> grids;
};
[[nodiscard]] ArmEstimate arm_estimate(const LeastSquaresProblem& problem, const DhhChain& chain,
                                       std::size_t grid_count, const std::vector<DhhPlace>& free);

}  // namespace palpate
