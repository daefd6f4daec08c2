/// Calibration of an arm's kinematics from places that its tip was put to (Ikits 2006, sec. 4.3).
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "common/calibration/fit_report.h"
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

struct ArmFitOptions {
  bool offsets_only = false;  ///< the joints' offsets alone: an encoder's reference pose
  Loss loss = Loss::kSquare;
  double loss_scale = 2e-3;  ///< [m], beyond which a robust loss bends
  std::size_t folds = 3;     ///< every third sample is left out, as in the reference
};

struct ArmFit {
  DhhChain chain;
  std::vector<Rigid> grids;  ///< of each grid in the first one's frame
  /// Errors "nominal", "offsets", and "full" unless offsets_only; "predicted" is what the fit's uncertainty makes
  /// of the tip's place over the workspace (predicted_errors()).
  FitReport report;
};

/// Largest uncertainty of the tip over the workspace with which an arm is of use [m].
inline constexpr double kMostPredicted = 0.010;

/// @param nominal where the search starts; its `free` flags say what a full fit estimates.
/// @throws Error (bad input) for fewer measurements than unknowns, and for sets that cannot tell parameters
/// apart, or leave the tip uncertain by more than kMostPredicted somewhere in the workspace: names them and says
/// where to measure next. For readings in degrees and places in millimetres; (work failed) for a fit that leaves
/// as much as there was before.
[[nodiscard]] ArmFit calibrate_arm(const MeasurementTable<ArmMeasurement>& table, const DhhChain& nominal,
                                   const ArmFitOptions& options);

/// The standard deviation of the tip's place [m] at readings drawn from the ranges that were seen, widened to
/// those of use:
///
///   sigma sqrt(trace(J C J^T)),   C = (A^T A)^-1
///
/// A the derivatives of all residuals by all unknowns, J those of the tip by the chain's numbers. Reproducible.
/// @param linear of arm_problem() at `estimate`; @param sigma of a measurement along an axis [m].
[[nodiscard]] std::vector<double> predicted_errors(const std::vector<ArmMeasurement>& rows,
                                                   const ArmEstimate& estimate,
                                                   const std::vector<DhhPlace>& free,
                                                   const Linearization& linear, double sigma);

/// Tries further grids in planes through and beside the places measured so far, each with an unknown frame of
/// its own and twenty poses that the arm reaches with readings like those seen, and ranks them by the
/// condition number that all measurements would have together. Reproducible.
/// @param now the condition number without.
/// @return sentences, the best grid first; empty where no candidate helps.
[[nodiscard]] std::vector<std::string> where_to_measure_next(const std::vector<ArmMeasurement>& rows,
                                                             const ArmEstimate& estimate,
                                                             const std::vector<DhhPlace>& free, double now);

}  // namespace palpate
