#include "common/field/layer/wall_layer.h"

#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <string>
#include <utility>

#include "common/base/text.h"
#include "common/field/layer/laplace.h"
#include "common/field/layer/wall_measures.h"
#include "common/field/layer/wall_surfaces.h"

namespace palpate {

WallLayer make_wall_layer(const DataSet& mesh, const std::string& file, int threads) {
  return make_wall_layer(*make_field_grid(std::span(&mesh, 1), file, threads), mesh, file, threads);
}

WallLayer make_wall_layer(const FieldGrid& grid, const DataSet& mesh, const std::string& file, int threads,
                          std::span<const SurfacePaint> paint) {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  const WallSurfaces surfaces = find_painted_surfaces(grid, mesh, file, paint);
  const WallPotential depth = solve_laplace(*grid.tets, depths_on(surfaces), file, threads);

  WallLayer layer;
  layer.notes = notes_of(surfaces);
  if (std::string doubt = monotone_doubt(monotone_share(grid, surfaces, depth.values)); !doubt.empty())
    layer.notes.push_back(std::move(doubt));
  layer.iterations = depth.iterations;
  layer.residual = depth.residual;
  std::vector<double> values(mesh.point_count(), kNaN);
  std::size_t without = 0;
  for (std::size_t input = 0; input < values.size(); ++input) {
    const std::size_t p = grid.point_of_input.empty() ? input : grid.point_of_input[input];
    if (p < depth.values.size()) values[input] = depth.values[p];
    without += std::isnan(values[input]) ? 1 : 0;
  }
  if (depth.thin_cells > 0)
    layer.notes.push_back(counted(depth.thin_cells, "cell") + " too thin to have a say in the layers");
  if (depth.beyond > 0)
    layer.notes.push_back("depths beyond the surfaces brought back to them at " +
                          counted(depth.beyond, "point") + ", by " + short_number(depth.farthest) +
                          " at most");
  if (without > 0)
    layer.notes.push_back(counted(without, "point") + " that no cell joins to a surface: no layer there");
  layer.array = make_array(kLayerArray, Association::kPoint, 1, std::span<const double>(values));
  return layer;
}

}  // namespace palpate
