/// The value that parts a scalar field best into two: what is shown and felt of a volume before anybody has
/// chosen an isovalue.
#pragma once

#include "common/field/scalar_field.h"

namespace palpate {

/// Otsu's threshold (value_histogram.h) of the values at the points, in 1024 bins over their range, data
/// units. A formula is asked on a lattice. The lowest value where there is no range; 0 where no value is
/// finite.
[[nodiscard]] double otsu_threshold(const ScalarField& field);

}  // namespace palpate
