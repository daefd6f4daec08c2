/// Whether the axes of a tensor image are those that its anatomy has: a gradient table with a flipped or
/// swapped axis gives tensors that fit well and point the wrong way.
///
/// Along a bundle, main directions d point at the neighbours that share them. For pairs (u, v) of neighbours a
/// step o' apart, and every turn T of the tensors that a wrong table can stand for, over FA > 0.2:
///   P(o', o) = sum FA_u FA_v (T d_u . o)^4 (T d_v . o)^4                                  (1)
/// with o, o' the 13 lines to the 26 neighbours. Directions that know nothing of their places make P a product
/// of its row sums R and column sums C, as uniform fibres do whatever the shape of voxels and the turn. So
///   s(T) = sum_o P(o, o) / ( sum_o R(o) C(o) / sum_o R(o) ) - 1                           (2)
/// counts only whether alike neighbours lie along the fibre. A smooth form of the fibre coherence index of
/// Schilling et al. 2019 ("A fiber coherence index for quality control of B-table orientation in diffusion MRI
/// scans"), which counts pairs within an angle; the comparison with independence is ours.
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "common/field/data_set.h"
#include "common/math/vec.h"

namespace palpate {

/// A turn along an image's own axes: component a of a direction becomes its component `from[a]`, with the
/// other sign where `flipped[a]`.
struct AxisTurn {
  std::array<int, 3> from{0, 1, 2};
  std::array<bool, 3> flipped{};

  [[nodiscard]] Mat3 matrix() const noexcept;
  [[nodiscard]] bool is_identity() const noexcept;
  /// As options: "--permute jik --flip k"; empty for the identity.
  [[nodiscard]] std::string words() const;
};

/// The 24 turns that differ for directions without sign: six permutations, each with no or one flip. The
/// first is the identity.
[[nodiscard]] std::vector<AxisTurn> axis_turns();

/// Main directions of the voxels that count in (1), computed once for any number of turns.
class DirectionMap {
 public:
  /// @param tensors xx xy xz yy yz zz of every point, NaN where there is none, in the data's axes.
  DirectionMap(std::span<const float> tensors, const UniformTopology& topology, int threads);

  /// s(T) for each of `turns`, in the data's axes; the same for any number of threads.
  [[nodiscard]] std::vector<double> coherence(std::span<const Mat3> turns, int threads) const;
  /// Voxels that count.
  [[nodiscard]] std::size_t size() const noexcept { return count_; }

 private:
  Index3 points_{0};
  Mat3 axes_{1.0};
  std::vector<std::array<float, 4>> directions_;  ///< x, y, z and FA; FA 0 where the voxel does not count
  std::size_t count_ = 0;
};

struct OrientationVerdict {
  AxisTurn best;
  double gain = 1.0;        ///< (1 + s(best)) / (1 + s(identity))
  bool suspicious = false;  ///< the best turn is not the identity, by so much that it is no chance
};

/// Scores all turns along the image's axes. Nothing is suspicious where fewer than 200 voxels count: these
/// are no anatomy.
[[nodiscard]] OrientationVerdict check_orientation(const DirectionMap& directions,
                                                   const UniformTopology& topology, int threads);

}  // namespace palpate
