/// The diffusion weighting of a series of volumes.
///
/// Symbols: b_i diffusion weighting of volume i [s/mm^2]; g_i unit gradient direction in the axes of the data
/// frame X (RAS for medical images), zero where the volume has none.
#pragma once

#include <vector>

#include "common/math/vec.h"

namespace palpate {

struct GradientTable {
  std::vector<double> weightings;  ///< b_i, not below zero
  std::vector<Vec3> directions;    ///< g_i, as many

  [[nodiscard]] double largest_weighting() const noexcept;
  /// Whether volume i counts as not weighted: b_i below a twentieth of the largest (scanners write small
  /// values for zero), or no direction.
  [[nodiscard]] bool unweighted(std::size_t i) const noexcept;
  [[nodiscard]] std::size_t unweighted_count() const noexcept;
};

/// Most volumes that a table may have: what a file or helper program claims beyond is refused.
inline constexpr std::size_t kMostGradients = 4096;

}  // namespace palpate
