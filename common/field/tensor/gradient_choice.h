/// Which volumes of a diffusion-weighted series a fit takes, with which weightings, and how well these
/// determine a tensor.
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "common/field/tensor/gradient_table.h"

namespace palpate {

struct GradientChoice {
  /// Where directions are not all of unit length (by 1 % of its square), b_i becomes b_i |g_i|^2: scanners
  /// store shells so (MRtrix 3, `-bvalue_scaling`).
  bool scale_by_length = true;
  std::vector<std::size_t> left_out;  ///< volumes, counted from 0
  double max_weighting =
      std::numeric_limits<double>::infinity();  ///< [s/mm^2], after scaling; 5 % more passes
  std::vector<double> shells;  ///< the weightings to be taken [s/mm^2], to 5 %; empty: all. Unweighted stay
};

/// The volumes that are taken.
struct ChosenGradients {
  GradientTable table;               ///< directions of unit length or zero
  std::vector<std::size_t> volumes;  ///< their numbers in the series, as many
  std::vector<std::string> notes;    ///< scaling, and what was left out and why
};

/// Volumes that are weighted and have no direction are left out (trace images); where there is no other
/// unweighted volume they are the unweighted ones (GE states the b-value of its shell for these, and MRtrix
/// reads them so).
/// @param stated directions of any length. @param file for messages.
/// @throws Error (usage) for volumes and shells that there are none of.
[[nodiscard]] ChosenGradients choose_gradients(const GradientTable& stated, const GradientChoice& choice,
                                               const std::string& file);

/// How well a table determines a tensor.
struct TableQuality {
  /// Ratio of the largest and the least singular value of the rows (xx, 2 xy, 2 xz, yy, 2 yz, zz) of the
  /// weighted volumes (Skare et al. 2000): 1.32 at least, 1.58 for evenly spread directions.
  double condition = 0.0;
  /// Standard deviations of Dxx Dxy Dxz Dyy Dyz Dzz over those that as many directions, evenly spread, give
  /// with the same weightings: ordinary least squares on signals of equal noise.
  std::array<double, 6> noise_gain{};
};
/// Above it a table is said to be ill-conditioned.
inline constexpr double kMostCondition = 5.0;

/// @pre gradient_problem(table) is empty.
[[nodiscard]] TableQuality quality_of(const GradientTable& table);

/// A shell: the weightings that lie together, and the directions of its volumes that differ.
struct Shell {
  double least = 0.0, most = 0.0;  ///< [s/mm^2]
  std::size_t volumes = 0;
  std::size_t directions = 0;
};
/// By rising weighting, the unweighted volumes first where there are any.
[[nodiscard]] std::vector<Shell> shells_of(const GradientTable& table);

/// "b 0: 1 volume; b 1000: 30 volumes in 30 directions"
[[nodiscard]] std::string shells_text(const std::vector<Shell>& shells);

}  // namespace palpate
