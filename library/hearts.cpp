#include "library/palpate/hearts.h"

#include <utility>

#include "common/field/layer/wall_layer.h"
#include "library/access.h"

namespace palpate::api {

Layers layers(const SharedDoubles& points, std::span<const std::int64_t> cells, int threads,
              const Watcher& watch) {
  return watched(watch, [&](Progress& /*progress*/) {
    DataSet mesh;
    mesh.topology = tetrahedra_of(points, cells);
    WallLayer solved = make_wall_layer(mesh, "points", threads);
    Layers out{.depth = {},
               .notes = std::move(solved.notes),
               .iterations = solved.iterations,
               .residual = solved.residual};
    out.depth.reserve(solved.array.tuples);
    for (std::size_t p = 0; p < solved.array.tuples; ++p) out.depth.push_back(solved.array.at(p));
    return out;
  });
}

}  // namespace palpate::api
