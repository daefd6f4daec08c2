/// The value that parts a scalar field best into two: what is shown and felt of a volume before anybody has
/// chosen an isovalue.
#pragma once

#include "common/field/scalar_field.h"
#include "common/field/value_histogram.h"

namespace palpate {

/// How many of the values at the points lie in each of 1024 bins over their range, local values; a formula is
/// asked on a lattice. @pre field.lowest() <= field.highest().
[[nodiscard]] ValueHistogram value_histogram(const ScalarField& field);

/// Otsu's threshold (value_histogram.h) of value_histogram(), data units. The lowest value where there is no
/// range; 0 where no value is finite.
[[nodiscard]] double otsu_threshold(const ScalarField& field);

}  // namespace palpate
