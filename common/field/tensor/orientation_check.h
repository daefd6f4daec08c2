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
///
/// A straight bundle alone (a spinal cord) has s(T) near 0 for all T, or a chance one: border_check.h is asked then.
///
/// How far chance goes is asked of the image itself: s(T) is taken again without each of its eight octants
/// (the jackknife of Quenouille and Tukey over blocks; neighbouring voxels are alike, so that single ones are no
/// independent samples).
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "common/field/data_set.h"
#include "common/field/tensor/border_check.h"
#include "common/field/tensor/vector_frame.h"
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
  [[nodiscard]] std::string text() const;
};

/// The 24 turns that differ for directions without sign: six permutations, each with no or one flip. The
/// first is the identity.
[[nodiscard]] std::vector<AxisTurn> axis_turns();

/// s(T) of all voxels, and without those of each octant.
struct Coherence {
  static constexpr std::size_t kBlocks = 8;
  double score = 0.0;
  std::array<double, kBlocks> without{};

  bool operator==(const Coherence&) const = default;
};
/// Whether `a` lines up better than `b` by more than chance gives: alike neighbours do lie along the fibres of
/// `a` (s > 0.02), by `by` more than along those of `b`, and by 1.5 standard errors of the difference.
[[nodiscard]] bool clearly_better(const Coherence& a, const Coherence& b, double by = 0.02) noexcept;

/// Main directions of the voxels that count in (1), computed once for any number of turns.
class DirectionMap {
 public:
  /// @param tensors xx xy xz yy yz zz of every point, NaN where there is none, in the data's axes.
  DirectionMap(std::span<const float> tensors, const UniformTopology& topology, int threads);

  /// s(T) for each of `turns`, in the data's axes; the same for any number of threads.
  [[nodiscard]] std::vector<Coherence> coherence(std::span<const Mat3> turns, int threads) const;
  /// By how much main directions turn where `others` takes the place of `turn`: the median [degrees] over blocks of
  /// 5 x 5 x 5 voxels, whose mean leaves noise out; 0 where no voxel counts.
  [[nodiscard]] double median_turn(const Mat3& turn, const Mat3& others) const;
  /// The borders in the image, which do not depend on directions.
  [[nodiscard]] BorderMap borders() const {
    return {directions_, shape_, UniformTopology{points_, Vec3{0.0}, axes_}};
  }
  /// Voxels that count.
  [[nodiscard]] std::size_t size() const noexcept { return count_; }

 private:
  Index3 points_{0};
  Mat3 axes_{1.0};
  std::vector<std::array<float, 4>> directions_;  ///< x, y, z and FA; FA 0 where the voxel does not count
  std::vector<std::array<float, 2>> shape_;       ///< FA and MD; NaN where there is no tensor
  std::size_t count_ = 0;
};

/// Fewer voxels are no anatomy.
inline constexpr std::size_t kLeastCoherent = 200;

/// What is taken of the numbers in a file: the frame that they are along, and a turn behind it.
struct Orientation {
  VectorFrame frame = VectorFrame::kScanner;
  AxisTurn turn;

  /// From numbers in the file to the data's axes. @param axes of the image.
  [[nodiscard]] Mat3 matrix(const Mat3& axes) const noexcept;
};

struct OrientationVerdict {
  Orientation best;  ///< the frame that would be right, and the turn behind the one that was taken
  /// The options that say so, "--vectors scanner --flip k"; empty: nothing is suspicious.
  std::string advice;
  double gain = 1.0;        ///< (1 + s(best)) / (1 + s(as taken))
  bool suspicious = false;  ///< the best is clearly_better() than what was taken
  /// Suspicious, or what was taken is clearly better than half of all others are. Where fibres fill an image so
  /// smoothly that other axes do as well, nothing can be said of them.
  bool judged = false;
  bool rotated = false;  ///< suspicious, and a rotation by 10 degrees behind the best is clearly better still
  /// Neighbours say nothing, or what the borders in the image speak against: all of this but `gain` is what those say.
  bool by_borders = false;
  double across = 0.0, across_best = 0.0;  ///< B as taken and in the best axes, where the borders say it
  /// Other turns that the borders do not tell from the best one, as options ("" is what was taken).
  std::vector<std::string> alike;
};

/// Scores frames, turns along the image's axes, and their combinations; where that decides nothing, or advises anything, asks the borders of turns. Of
/// those that are as good that one is best which changes least: the turn, the frame, both. Nothing is
/// suspicious where fewer than kLeastCoherent voxels count.
/// @param directions of tensors that were read as `taken`.
[[nodiscard]] OrientationVerdict check_orientation(const DirectionMap& directions,
                                                   const UniformTopology& topology, const Orientation& taken,
                                                   int threads);

}  // namespace palpate
