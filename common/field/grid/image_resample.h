/// Images on other lattices: slices and crops of a uniform image.
///
/// Symbols.  g grid coordinates, whole numbers at the points; x = origin + axes g data coordinates. Values
/// are trilinear between points.
#pragma once

#include <optional>
#include <vector>

#include "common/field/data_set.h"
#include "common/field/grid/lattice_lines.h"
#include "common/math/vec.h"

namespace palpate {

/// The plane n.x = d, n unit, pointing to who looks at it.
struct ImagePlane {
  Vec3 normal{0.0, 0.0, 1.0};
  double offset = 0.0;  ///< d [data units]
};

/// A lattice of one layer over where the plane cuts the box of all points of `image`. Its first axis runs to
/// the right and its second one up, as who looks at the plane sees them: up is z, or y where the plane faces
/// along z. Along an axis of the image it steps as the image does, on planes of its points from point to
/// point; along any other direction by the image's shortest step.
/// @param spacing of the lattice along both axes; absent: as above.
/// @return nothing where the plane passes by.
[[nodiscard]] std::optional<UniformTopology> plane_lattice(const UniformTopology& image,
                                                           const ImagePlane& plane,
                                                           std::optional<double> spacing);

/// Whole grid coordinates of the points in a box, both ends included.
struct IndexBox {
  Index3 first{0}, last{-1};

  [[nodiscard]] Index3 points() const noexcept { return last - first + 1; }
};
/// The smallest part of an image that holds all its points in `box`: exactly those where axes are parallel.
/// @param lines of `image`, whose steps are mean ones then; null: they are even.
/// @return nothing where the image has none there.
[[nodiscard]] std::optional<IndexBox> points_in(const UniformTopology& image, const Box& box,
                                                const LatticeLines* lines = nullptr);
/// The lattice of that part. @pre it lies in the image.
[[nodiscard]] UniformTopology part_of(const UniformTopology& image, const IndexBox& part) noexcept;

/// The values of that part, of all components, in their type; sparse ones in single precision. @pre it lies in the image.
[[nodiscard]] DataArray values_of(const UniformTopology& image, const DataArray& values,
                                  const IndexBox& part);

struct ResampledImage {
  std::vector<float> values;  ///< at the points of the lattice, x fastest
  std::size_t outside = 0;    ///< points beyond the image, or with a voxel about them that has no value
};
/// `values` at the points of `lattice`, computed in double precision.
/// @param filler where there is no value. @param lines as of points_in(). @pre one finite grid; values.tuples are its points; component
/// exists. The result does not depend on the number of threads (0: all cores).
[[nodiscard]] ResampledImage resample(const UniformTopology& image, const DataArray& values, int component,
                                      const UniformTopology& lattice, float filler, int threads,
                                      const LatticeLines* lines = nullptr);

}  // namespace palpate
