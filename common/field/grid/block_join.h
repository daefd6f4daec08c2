/// The points of several blocks as one list, joined where the blocks meet.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
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

/// Whether two points at the same place, counted through all blocks, have the same values; empty where all have.
using PointsAgree = std::function<bool(std::uint32_t, std::uint32_t)>;

struct JoinedPoints {
  std::vector<Vec3> points;                ///< data coordinates, block after block
  std::vector<std::uint8_t> odd;           ///< i + j + k of structured points is odd
  std::vector<std::uint32_t> first_of;     ///< for each point, the one that it is joined with
  std::vector<std::uint32_t> place_of;     ///< likewise, whatever their values
  std::vector<std::uint32_t> first_point;  ///< of each block
  std::size_t merged = 0;                  ///< points for which another one stands
  double unit = 1.0;                       ///< power of two that makes lengths about one
};

[[nodiscard]] bool structured(const DataSet& block) noexcept;

/// Checks the blocks and joins their points.
/// @throws Error (bad input) with `file` where sizes disagree, or points or cells are too many to be
/// numbered.
[[nodiscard]] JoinedPoints join_blocks(std::span<const DataSet> blocks, const std::string& file,
                                       const PointsAgree& agree = {});

/// A point that may be joined with others.
struct MergeCandidate {
  std::uint32_t point = 0;  ///< index into the positions
  double spacing = 0.0;     ///< shortest edge at the point that is not zero; 0 where it has none
  std::uint32_t block = 0;
  bool within_block = false;  ///< may be joined with points of its own block too (seams of O- and C-grids)
};

/// For every position the first one that it is joined with (itself where there is none): candidates p, q
/// closer than `distance` times the smaller of their spacings, in the order given. Each is compared with
/// first ones alone, so that chains of close points do not creep. Where `agree` is given, points that it parts
/// stay apart. Two points that may not be joined are joined with the same third one only where `through_others`.
/// @pre positions of candidates are finite; distance <= 2^-2.
[[nodiscard]] std::vector<std::uint32_t> merge_points(std::span<const Vec3> positions,
                                                      std::span<const MergeCandidate> candidates,
                                                      double distance, const PointsAgree& agree = {},
                                                      bool through_others = true);

}  // namespace palpate
