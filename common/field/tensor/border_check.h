/// What the borders in a tensor image say of the axes of its directions: fibres run along the borders of what they make up.
///
/// Neighbours of one straight bundle line up in any axes (orientation_check.h says nothing of them), but the bundle has
/// sides: a spinal cord against its fluid, white matter against the grey within. With g the gradients of FA and of
/// the logarithm of MD, which know no direction, d main directions, T a turn, and over FA > 0.2:
///   B(T) = sum w (g' . T d) (g'' . T d) / sum w g' . g''                                   (1)
/// is 0 where fibres run along all borders and 1/3 where they know nothing of them. w is FA^2 times how far the 26
/// neighbours agree in direction, whatever it is: noise has directions, too. g' comes of the six nearest
/// neighbours, g'' of the twenty others: their noise has no voxel in common, so that the noise of anisotropic voxels makes
/// no borders (the products of one estimate would). Voxels whose neighbours have no tensor, at rims of masks and of
/// the image, do not count: an end that somebody cut is no border.
///
/// Turns that put directions across the borders are told by (1); flips of a bundle that is nearly straight turn them by some
/// degrees only. For these the image is cut into twelve parts along its longest axis. In each, borders have an axis a
/// (what their gradients avoid) and directions a mean e. If T is right where S is taken, a leaves S e as T e does:
///   a - S e = b (T e - S e) + rest,  b = 1;  b = 0 where S is right.                       (2)
/// The fit of b over the parts has a standard error of its own: what bends a border but no fibre (distortions, motion
/// between slices) is the rest. Errors of (1) are those of leaving out each part in turn.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "common/field/data_set.h"
#include "common/math/vec.h"

namespace palpate {

/// Sums over one part of an image.
struct BorderSums {
  Mat3 borders{0.0};               ///< sum of w (g' g''^T + g'' g'^T) / 2
  Mat3 directions{0.0};            ///< sum of w d d^T
  std::array<Mat3, 6> products{};  ///< of w d d^T and each of the six numbers of `borders`
};

/// What borders say of turns, the first of which was taken.
struct BorderVerdict {
  /// There are borders, and in the best axes directions follow them. If not, nothing else here is said.
  bool clear = false;
  std::vector<double> across;  ///< B of each turn
  std::vector<bool> excluded;  ///< another turn is better beyond doubt
  /// Of answers that are not excluded, the first whose B is hardly above the least.
  std::size_t best = 0;
  bool rotated =
      false;  ///< in the best one directions are turned from the borders everywhere, alike, by over ten degrees
};

/// The borders of an image, computed once for any number of turns.
class BorderMap {
 public:
  static constexpr std::size_t kParts = 12;
  /// @param directions x, y, z and FA of every point, FA 0 where it does not count.
  /// @param shape FA and MD of every point, NaN where there is no tensor.
  BorderMap(std::span<const std::array<float, 4>> directions, std::span<const std::array<float, 2>> shape,
            const UniformTopology& topology);

  /// @param turns in the data's axes; all are judged, the first `answers` of them may be better than another.
  [[nodiscard]] BorderVerdict judge(std::span<const Mat3> turns, std::size_t answers) const;

 private:
  std::array<BorderSums, kParts> parts_{};
  std::size_t count_ = 0;
  double step_ = 0.0;  ///< between voxels, of an isotropic voxel as large as these
};

}  // namespace palpate
