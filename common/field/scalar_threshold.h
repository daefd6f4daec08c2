/// The value that parts a scalar field best into two: what is shown and felt of a volume before anybody has
/// chosen an isovalue.
#pragma once

#include "common/field/scalar_field.h"

namespace palpate {

/// Otsu's threshold (Otsu 1979), data units: of the values at the points, in 1024 bins over their range, the
/// border between bins by which the mean values of both classes differ most from the mean of all,
///
///   w_0 w_1 (mu_0 - mu_1)^2   is largest, w the classes' weights and mu their means,
///
/// the middle of all borders that are as good. A formula is asked on a lattice. The lowest value where there
/// is no range; 0 where no value is finite.
[[nodiscard]] double otsu_threshold(const ScalarField& field);

}  // namespace palpate
