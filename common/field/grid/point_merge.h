/// Joining points of different blocks that lie at the same place.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "common/math/vec.h"

namespace palpate {

/// A point that may be joined with others.
struct MergeCandidate {
  std::uint32_t point = 0;  ///< index into the positions
  double spacing = 0.0;     ///< shortest edge at the point that is not zero; 0 where it has none
  std::uint32_t block = 0;
  bool within_block = false;  ///< may be joined with points of its own block too (seams of O- and C-grids)
};

/// For every position the first one that it is joined with (itself where there is none): candidates p, q
/// closer than `distance` times the smaller of their spacings, in the order given. Each is compared with
/// first ones alone, so that chains of close points do not creep.
/// @pre positions of candidates are finite; distance <= 2^-2.
[[nodiscard]] std::vector<std::uint32_t> merge_points(std::span<const Vec3> positions,
                                                      std::span<const MergeCandidate> candidates,
                                                      double distance);

}  // namespace palpate
