/// How far a traced line is from the exact one.
#pragma once

#include <vector>

#include "common/math/vec.h"

namespace palpate::bench {

struct Curve {
  std::vector<Vec3> points;
  bool leaves = false;  // ends on the border
};

/// The error that 95 % of the lines stay under, in diagonals: the largest distance of a line's points (but
/// the last) from the exact curve of the same index; infinite where the line stops early.
[[nodiscard]] double quantile_error(const std::vector<Curve>& lines, const std::vector<Curve>& exact,
                                    double diagonal);

}  // namespace palpate::bench
