/// A scalar of any grid or formula taken at the points of a uniform one, and how far its interpolant there is
/// from it.
///
/// Symbols.
///   s(x)    the scalar, data coordinates
///   s_h(x)  trilinear between the values of s at the points of the lattice
///   R       highest less lowest of these values
///
///   rms = sqrt(mean (s_h - s)^2) / R        worst = max |s_h - s| / R                           (1)
///
/// over random places of the lattice's box at which both have a value. Of a vortex measure, which jumps from
/// cell to cell, (1) is large on any lattice.
#pragma once

#include <cstddef>
#include <functional>
#include <string>

#include "common/base/progress.h"
#include "common/field/data_set.h"
#include "common/field/sample.h"
#include "common/field/vector_field.h"

namespace palpate {

/// Samples at `x` in data coordinates, on any thread.
using ScalarSampler = std::function<ScalarSample(const Vec3& x_data, CellHint& hint)>;

/// `longest` points along the longest edge of `bounds`, along the others as many as make cells most like
/// cubes, two at least. @pre longest >= 2, `bounds` is not empty.
[[nodiscard]] Index3 cubic_points(const Box& bounds, int longest) noexcept;

/// The lattice of `points` whose outermost ones lie on the faces of `bounds`. @pre points >= 2 on each axis.
[[nodiscard]] UniformTopology lattice_over(const Box& bounds, const Index3& points) noexcept;

/// One uniform block with a point array `name` of double precision, NaN where `sample` has no value: outside
/// its grid, or at bad data. Points on the very border count as inside. The result does not depend on the
/// number of threads (0: all cores).
/// @throws Cancelled.
[[nodiscard]] DataSet take_scalar(const ScalarSampler& sample, const std::string& name,
                                  const UniformTopology& lattice, int threads, Progress* progress);

/// What a lattice costs; shares are of random places, uniform in its box.
struct LatticeError {
  double rms = 0.0;          ///< (1); 0 where R is
  double worst = 0.0;        ///< (1), likewise
  double outside = 0.0;      ///< share of the box at which the scalar has no value: nothing is drawn there
  double hidden = 0.0;       ///< share of the rest whose cell has a corner without a value: neither is there
  std::size_t compared = 0;  ///< places that (1) rests on
};

/// @param block of take_scalar(), from the same sampler.
/// @throws Cancelled.
[[nodiscard]] LatticeError lattice_error(const ScalarSampler& sample, const DataSet& block, int threads,
                                         Progress* progress, std::size_t places = 20'000);

}  // namespace palpate
