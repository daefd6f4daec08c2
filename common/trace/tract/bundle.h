/// What a bundle of tracts is as a whole: which voxels it passes, and how a measure goes along it.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "common/geometry/tractogram.h"
#include "common/math/vec.h"

namespace palpate {

/// How many lines pass each voxel. A voxel reaches half a step to either side of its centre; a line that passes it
/// several times counts once, one that only touches its border may count or not.
struct BundleDensity {
  std::vector<float> lines;  ///< of every voxel, the first axis fastest
  std::size_t voxels = 0;    ///< that any line passes
  double volume = 0.0;       ///< of those [mm^3]
  std::size_t outside = 0;   ///< lines of which a part lies outside the image, or at no finite place
};

/// Goes through every voxel that a piece of a line passes (Amanatides and Woo 1987), however far its ends are apart;
/// a piece that begins or ends a thousand million voxels away counts as outside.
/// @pre the image's axes are independent.
[[nodiscard]] BundleDensity bundle_density(const Tractogram& lines, const TractogramImage& image);

/// A place along a bundle: what all lines have there.
struct BundleNode {
  Vec3 place{0.0};                     ///< mean of the lines' places [mm]
  std::size_t lines = 0;               ///< that have a value there
  std::size_t valueless = 0;           ///< that have none: outside the image, or no number in it
  double mean = 0.0, deviation = 0.0;  ///< of the values; the deviation of a sample, NaN of fewer than two
  double lower = 0.0, median = 0.0, upper = 0.0;  ///< quartiles; all five NaN where no line has a value
};

/// A measure along a bundle.
struct BundleProfile {
  std::vector<BundleNode> nodes;  ///< at equal parts of each line's length, ends included
  std::size_t lines = 0;          ///< that count
  std::size_t turned = 0;         ///< of those, stored from the other end
  std::size_t left_out = 0;       ///< of fewer than two places, no length, or places that are not finite
};

/// The value at a place in mm; NaN: none.
using PlaceValue = std::function<double(const Vec3&)>;

/// Lines are stored from either end. They are put in one direction by the middle line: the one of up to 200, spread
/// evenly over the file, that lies nearest to the others (the smaller mean distance of 12 places on each, as they are
/// and turned: Garyfallidis, Brett, Correia, Williams and Nimmo-Smith 2012). Node 0 lies at that end of it which has
/// the smaller coordinate on the axis along which its ends differ most: to the left, the back or the feet.
/// @param nodes at least 2.
[[nodiscard]] BundleProfile bundle_profile(const Tractogram& lines, int nodes, const PlaceValue& value);

}  // namespace palpate
