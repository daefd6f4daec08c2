/// The wall of a heart: how deep in it each point lies.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <palpate/palpate.h>

namespace palpate::api {

/// The depth of the points of a mesh in its wall.
struct Layers {
  std::vector<double>
      depth;  ///< by point, from 0 at the inner to 1 at the outer surface; NaN in parts that touch neither
  std::vector<std::string> notes;  ///< which surfaces were found, how well it was solved: sentences
  int iterations = 0;
  double residual = 0.0;  ///< |b - A u| / |b| of the linear equations at the end
};

/// Solves Laplace's equation in tetrahedra between their inner and their outer surface, which are found by the mesh's
/// shape, as `cardiac` does for meshes that come without layers.
/// @param points three numbers each. @param cells four points each, in any order.
/// @throws Error (bad input) for a corner that is no point and for meshes without an inner and an outer surface; (work
/// failed) where the iteration does not converge.
[[nodiscard]] PALPATE_API Layers layers(const SharedDoubles& points, std::span<const std::int64_t> cells,
                                        int threads = 0, const Watcher& watch = {});

}  // namespace palpate::api
