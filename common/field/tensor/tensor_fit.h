/// Diffusion tensors fitted to diffusion-weighted signals, by least squares on their logarithms.
///
/// Symbols. S_i signal of volume i; b_i, g_i its weighting and direction (gradient_table.h); D the tensor.
///
///   log S_i = log S_0 - b_i g_i^T D g_i                                                   (1)
///
/// is linear in the seven unknowns log S_0 and D (Basser, Mattiello and LeBihan 1994). The noise of log S_i
/// goes as 1 / S_i, so that (1) is weighted by S_i^2: first with the measured signals, then twice with those
/// that the last fit predicts (Veraart et al. 2013), which is what MRtrix's dwi2tensor does by default.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "common/base/progress.h"
#include "common/field/data_set.h"
#include "common/field/tensor/gradient_table.h"

namespace palpate {

enum class FitWeights : std::uint8_t {
  kSignal,   ///< S_i^2, as above
  kOrdinary  ///< all alike: the fit is linear in log S_i
};

/// What becomes of tensors with an eigenvalue below zero, which noise makes.
enum class NegativeEigenvalues : std::uint8_t {
  kKept,  ///< as fitted: measures take the eigenvalue as zero
  kZero   ///< the eigenvalue becomes zero
};

struct FitOptions {
  FitWeights weights = FitWeights::kSignal;
  NegativeEigenvalues negative = NegativeEigenvalues::kKept;
  int threads = 0;       ///< the result does not depend on it
  bool details = false;  ///< cones and baselines, too
};

struct TensorFit {
  /// xx xy xz yy yz zz of every voxel, in the axes of the gradients and the inverse unit of the weightings;
  /// NaN where there is none.
  std::vector<float> tensors;
  /// @name With FitOptions::details, a number a voxel, NaN where there is no tensor
  /// @{
  std::vector<float> cones;      ///< cone_of_uncertainty() [degrees]
  std::vector<float> baselines;  ///< S_0
  /// @}
  std::size_t fitted = 0;    ///< voxels with a tensor
  std::size_t unusable = 0;  ///< in the mask, but no signal above zero or one that is not finite
  std::size_t lifted = 0;    ///< with a signal below 1e-6 of the voxel's largest (zero, negative): taken as
                             ///< that
  std::size_t negative = 0;  ///< with an eigenvalue below zero
};

/// Half the opening angle [degrees, up to 90] of the cone that holds the main direction with a probability of 95 %, by
/// the covariance of the fit. With r the residuals of (1), w their weights, n volumes and A the rows of (1),
///
///   C = s^2 (A^T w A)^-1,  s^2 = sum w r^2 / nu,  nu = n - 7                                  (2)
///   de_1 = sum_j e_j (e_j^T dD e_1) / (l_1 - l_j),  j = 2, 3                                  (3)
///
/// carry it to the plane across e_1, where L is the larger eigenvalue of the covariance of de_1. The half-angle is
/// atan sqrt(2 F L), F = nu (0.05^(-2/nu) - 1) / 2 the 95 % quantile of Fisher's distribution of 2 and nu degrees of
/// freedom: the long axis of the elliptical cone of Koay et al. 2007. 90 where l_1 = l_2; NaN for nu = 0, where
/// nothing is known of the noise.
/// @param rows of (1), weightings divided by the largest. @param solution of these.
[[nodiscard]] double cone_of_uncertainty(std::span<const std::array<double, 7>> rows,
                                         std::span<const double> weights, std::span<const double> logs,
                                         const std::array<double, 7>& solution);

/// What keeps `table` from determining a tensor ("the directions leave 2 of 7 unknowns open …"), or empty.
[[nodiscard]] std::string gradient_problem(const GradientTable& table);

/// @param signals a component a volume. @param mask a byte a voxel, 0 where no tensor is wanted; empty: all.
/// @pre gradient_problem(table) is empty, signals.components is the size of `table`.
/// @throws Cancelled.
[[nodiscard]] TensorFit fit_tensors(const DataArray& signals, const GradientTable& table,
                                    std::span<const std::uint8_t> mask, const FitOptions& options,
                                    const Progress* progress = nullptr);

}  // namespace palpate
