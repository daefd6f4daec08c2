/// An image at the points of another lattice, in the numbers that it has: between voxels in double precision, and the
/// voxels themselves.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "common/field/data_set.h"
#include "common/field/grid/lattice_lines.h"

namespace palpate {

/// `values` at the points of `lattice`, x fastest, trilinear; NaN beyond the image and beside voxels without a value.
/// @param lines of `image`, whose steps are mean ones then; null: they are even.
/// @pre one finite grid; values.tuples are its points; component exists. The result does not depend on the number of
/// threads (0: all cores).
[[nodiscard]] std::vector<double> values_on(const UniformTopology& image, const DataArray& values,
                                            int component, const UniformTopology& lattice, int threads,
                                            const LatticeLines* lines = nullptr);

struct NearestPoints {
  static constexpr std::size_t kBeyond = ~std::size_t{0};
  std::vector<std::size_t> index;  ///< of the image's point nearest to each of the lattice; kBeyond beyond it
  std::size_t outside = 0;         ///< points beyond the image
  bool exact = true;               ///< all others lie on points of the image
};
/// @pre as values_on().
[[nodiscard]] NearestPoints nearest_points(const UniformTopology& image, const UniformTopology& lattice,
                                           const LatticeLines* lines = nullptr);
/// The values there, of all components, in their type and with their bits.
/// @param beyond the bytes of a tuple beyond the image. @pre not sparse.
[[nodiscard]] DataArray values_at(const DataArray& values, const NearestPoints& points,
                                  std::span<const std::byte> beyond);

}  // namespace palpate
