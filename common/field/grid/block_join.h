/// The points of several blocks as one list, joined where the blocks meet.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "common/field/data_set.h"
#include "common/math/vec.h"

namespace palpate {

/// Border points of different blocks, and of one structured block, are joined where they are closer than
/// this part of the shortest edge at either of them.
inline constexpr double kMergeDistance = 0x1p-10;

/// "No point" in lists of point numbers.
inline constexpr std::uint32_t kNoPoint = 0xFFFFFFFFU;

struct JoinedPoints {
  std::vector<Vec3> points;                ///< data coordinates, block after block
  std::vector<std::uint8_t> odd;           ///< i + j + k of structured points is odd
  std::vector<std::uint32_t> first_of;     ///< for each point, the one that stands for its place
  std::vector<std::uint32_t> first_point;  ///< of each block
  std::size_t merged = 0;                  ///< points for which another one stands
  double unit = 1.0;                       ///< power of two that makes lengths about one
};

[[nodiscard]] bool structured(const DataSet& block) noexcept;

/// Checks the blocks and joins their points.
/// @throws Error (bad input) with `file` where sizes disagree, or points or cells are too many to be
/// numbered.
[[nodiscard]] JoinedPoints join_blocks(std::span<const DataSet> blocks, const std::string& file);

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
