/// Time at equal error of the end points: palpate's integrators beside tckgen's steps, on a built-in bundle.
#pragma once

#include <string>

namespace palpate::bench {

/// Makes the noise-free diffusion-weighted image of the bundle (voxels of 2 mm, one volume without weighting
/// and 30 directions) and its tensors in `folder`. Either program traces it from the same voxels by several
/// steps or tolerances. The error is the distance of the points 30 mm from the seed from those of the same
/// rule at tiny steps (for tckgen: signals interpolated, then fitted), so that it is the integrator's alone.
void print_equal_error(const std::string& bundle, const std::string& folder);

}  // namespace palpate::bench
