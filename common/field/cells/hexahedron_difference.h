/// How far linear tetrahedra are from the trilinear hexahedra that other programs show.
///
/// Both interpolants agree at the points of the data and, to second order in the cell size, everywhere.
/// Inside a hexahedron with corners x_c and values v_c the trilinear one is, for u in [0, 1]^3 with the
/// weights w_c(u), v(x) = sum_c w_c v_c at x = sum_c w_c x_c. It is compared at 27 points of every sampled
/// hexahedron, u in {1/6, 1/2, 5/6}^3.
#pragma once

#include <cstddef>
#include <span>

#include "common/field/data_set.h"
#include "common/field/vector_field.h"

namespace palpate {

struct HexahedronDifference {
  std::size_t cells = 0;  ///< hexahedra that were sampled
  double max = 0.0;       ///< largest |difference|, relative to the largest speed of the field
  double rms = 0.0;       ///< root mean square of it
};

/// Samples at most `most_cells` hexahedra, evenly spread over the cells of `blocks`, which are those that the
/// grid of `field` was made of. No cells where the field is not on tetrahedra or has no hexahedra.
[[nodiscard]] HexahedronDifference hexahedron_difference(const VectorField& field,
                                                         std::span<const DataSet> blocks,
                                                         std::size_t most_cells = 2000);

}  // namespace palpate
