/// How noisy a volume is from place to place: the standard deviation of what differs from voxel to voxel
/// without belonging to anything that goes on beside it, as a part of the range of the values.
///
/// Second differences along all axes at once take out whatever is linear along one of them, edges that lie
/// along the grid among it; of white noise of standard deviation sigma they leave one of sigma sqrt(6^axes).
/// A quantile of their sizes about a node tells that however much the places above it add (Donoho and
/// Johnstone 1994, the median on the finest scale of wavelets; Immerkaer 1996, differences on pictures). It
/// is the lower quartile here, since surfaces, about which the noise is wanted, pass through many places:
///
///   r = D_x D_y D_z s,   (D s)_i = s_(i-1) - 2 s_i + s_(i+1)
///   sigma = q_1/4 |r| / (0.3186 sqrt(6^axes))                                                     (1)
///
/// From one node to the next it scatters by a sixth of itself. Noise that neighbouring voxels share (of
/// images that were smoothed or interpolated) is told too small. Edges across all axes at once, sharp from
/// one voxel to the next, are told as noise of up to a twentieth of their height; blurred by a voxel, of a
/// thousandth.
#pragma once

#include <memory>

#include "common/field/scalar_field.h"

namespace palpate {

/// Sigma of (1) over highest() - lowest(), at nodes every fourth point of the grid (farther apart where that
/// would be more than 64 along an axis), from the 7^3 points about each, linear between; it holds the whole
/// of `field`. 0 where fewer than 27 places of a window tell of it: beside voxels that are not finite, in
/// images of one voxel's thickness along all axes, and where all values are the same.
/// @return null where `field` is not on a uniform or rectilinear grid. @throws std::bad_alloc.
[[nodiscard]] std::shared_ptr<const ScalarField> make_noise_field(const ScalarField& field, int threads = 0);

}  // namespace palpate
