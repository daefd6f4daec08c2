/// Curves of the mode `linear` from the data (Ikits 2006, ch. 9): `--measure auto`.
///
/// Symbols.  m = |grad s| at places of an even lattice, q_1/4 its lower quartile.
/// Where most of a volume is even, m there is that of its noise. Of noise alike in three directions m has Maxwell's
/// distribution, whose lower quartile is 1.101 sigma and whose 99th hundredth is 3.368 sigma, so that
///
///   b = 3.06 q_1/4        noise has no larger gradient but in one place of a hundred                  (1)
///   B = median of those m that exceed b and a tenth of the largest of them    a typical boundary      (2)
///
/// Materials are the peaks of the histogram of s where m <= b, smoothed by a sixteenth of its range.
#pragma once

#include <string>
#include <vector>

#include "common/field/scalar_field.h"
#include "common/field/value_histogram.h"
#include "common/haptics/constraint/linear_settings.h"

namespace palpate {

/// Of a scalar, data units.
struct ScalarStatistics {
  ValueHistogram values, gradients;
  double noise = 0.0;             ///< b of (1)
  double boundary = 0.0;          ///< B of (2); 0: there is none
  double boundaries = 0.0;        ///< share of places with m above b and the tenth
  std::vector<double> materials;  ///< by rising value, at most four

  /// Whether some stand out from the noise: B > 2 b, at one place in two thousand or more.
  [[nodiscard]] bool has_boundaries() const noexcept;
};
[[nodiscard]] ScalarStatistics scalar_statistics(const ScalarField& field);

/// `settings` with a measure and curves for it: where there are boundaries, the gradient, by which noise is faint (a quarter
/// of the stiffness, gives after 1 mm) and boundaries are whole (gives after 8 mm); else the value, by which each
/// material is stiffer than the one below it.
[[nodiscard]] LinearSettings proposed(LinearSettings settings, const ScalarStatistics& statistics);

/// What was found, in a sentence.
[[nodiscard]] std::string proposal_text(const LinearSettings& settings, const ScalarStatistics& statistics);

}  // namespace palpate
