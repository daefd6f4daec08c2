/// A scalar that rises from the inner surface of a wall to the outer one.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/field/data_set.h"
#include "common/field/field_grid.h"
#include "common/field/layer/paint_surfaces.h"

namespace palpate {

/// The array that make_wall_layer() makes.
inline constexpr const char* kLayerArray = "layer";

struct WallLayer {
  DataArray array;                 ///< of the points of the mesh, named kLayerArray: 0 inner, 1 outer
  std::vector<std::string> notes;  ///< which surfaces, how well it was solved
  int iterations = 0;
  double residual = 0.0;  ///< |b - A u| / |b| at the end
};

/// Layers that were solved before, such as those in a file (scene/layer_cache.h).
class CachedLayers {
 public:
  CachedLayers() = default;
  virtual ~CachedLayers() = default;
  CachedLayers(const CachedLayers&) = delete;
  CachedLayers& operator=(const CachedLayers&) = delete;

  /// Those of a mesh with the very same cells and surfaces; nothing where there are none.
  virtual std::optional<WallLayer> find(const DataSet& mesh) = 0;
  /// @param seconds that solving took.
  virtual void keep(const DataSet& mesh, const WallLayer& layer, double seconds) = 0;
};

/// Solves Laplace's equation in the tetrahedra of `mesh` (as make_field_grid() splits it) with u = 0 on the
/// inner and u = 1 on the outer surface (wall_surfaces.h) and no flux through the rest. Points of parts that
/// touch no surface, or that no cell with a volume uses, are NaN. On obtuse tetrahedra u may leave [0, 1]
/// a little: it is brought back there. Notes count such points, and cells too thin to have a say.
/// @throws Error (bad input) with `file` as find_wall_surfaces() and make_field_grid(); (work failed) where
/// the iteration does not converge.
[[nodiscard]] WallLayer make_wall_layer(const DataSet& mesh, const std::string& file, int threads = 0);

/// The same on the grid that was made of `mesh`, between surfaces that are painted (paint_surfaces.h).
[[nodiscard]] WallLayer make_wall_layer(const FieldGrid& grid, const DataSet& mesh, const std::string& file,
                                        int threads = 0, std::span<const SurfacePaint> paint = {});

}  // namespace palpate
