/// What the numbers of a data set are, for whoever shows it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/field/data_set.h"

namespace palpate {

/// Range of an array's component.
struct ComponentRange {
  double lower = 0.0;
  double upper = 0.0;
};

struct ArrayStatistics {
  std::vector<ComponentRange> ranges;  ///< one a component; finite values only
  std::uint64_t bad_values = 0;        ///< NaN and infinite numbers
};
/// Adds the values of one more block's array. The result does not depend on the number of threads.
void include_array(const DataArray& array, int threads, ArrayStatistics& statistics);

/// How the block lies: "RAS+ mm; voxel axes run to L, A, S; steps …". @param anatomical in RAS+ millimetres.
[[nodiscard]] std::string orientation_text(const DataSet& block, bool anatomical);

}  // namespace palpate
