/// A scalar taken on an image where it lies on another grid: what `--resample N` or N,N,N means, and what it costs.
#pragma once

#include <string>

#include "common/field/scalar_lattice.h"

namespace palpate {

/// A scalar that was taken on another grid than its own.
struct TakenScalar {
  std::string name;
  Index3 points{0};
  LatticeError error;
};
/// "speed on 128 x 64 x 64 points differs from the field by 0.3 % of its range (root mean square), 8 % at
/// worst; …"
[[nodiscard]] std::string taken_text(const TakenScalar& taken);

/// Refuses what `--resample` does not take; nothing is right. @throws Error (usage).
void check_resample(const std::string& text);
/// The points that `--resample text` asks for: N along the longest edge of `bounds`, or so many an axis.
/// @throws Error (usage).
[[nodiscard]] Index3 resample_points(const Box& bounds, const std::string& text);

}  // namespace palpate
